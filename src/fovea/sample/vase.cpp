#include <cmath>
#include <numbers>

#include "fovea/sample/builder.h"
#include "fovea/sample/curve.h"
#include "fovea/sample/sheet.h"
#include "fovea/sample/vase_paint.h"

namespace fovea::sample {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;  // radians

/// Half of the section through the axis, (radius, height): under the foot, up the outside, over the
/// lip and down the inside.
const Curve& section() {
  static const Curve kCurve({{0, 0.03},      {0.12, 0.03},   {0.20, 0.022},  {0.225, 0.0},   {0.243, 0.004},
                             {0.248, 0.03},  {0.215, 0.07},  {0.203, 0.10},  {0.270, 0.22},  {0.385, 0.42},
                             {0.450, 0.64},  {0.455, 0.80},  {0.400, 0.98},  {0.270, 1.11},  {0.185, 1.19},
                             {0.165, 1.28},  {0.175, 1.38},  {0.215, 1.455}, {0.262, 1.487}, {0.274, 1.500},
                             {0.264, 1.511}, {0.244, 1.506}, {0.190, 1.455}, {0.146, 1.37},  {0.136, 1.28},
                             {0.156, 1.19},  {0.240, 1.10},  {0.372, 0.97},  {0.427, 0.80},  {0.422, 0.64},
                             {0.357, 0.42},  {0.240, 0.23},  {0.10, 0.14},   {0, 0.13}});
  return kCurve;
}
// Where charts meet, as parameters of the section.
constexpr double kFoot = 4, kLipOutside = 18, kLipInside = 21, kFloor = 33;

/// A ring of the vase's wall at one height.
struct Ring {
  Vec2d point;       ///< Radius, height.
  double lobes = 0;  ///< Depth of the gadroons there.
};

std::vector<Ring> rings(double from, double to, int count) {
  std::vector<Ring> result;
  for (const Vec2d p : section().even(from, to, count)) result.push_back({p, 0});
  return result;
}

/// Gadroons: lobes that swell above the foot, as many as there are painted leaves.
void add_lobes(std::vector<Ring>& wall) {
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(wall.size() - 1);
    wall[i].lobes = 0.010 * smooth_step(0.07, 0.12, t) * smooth_step(0.205, 0.16, t);
  }
}

/// Wall around the axis; the back (-z) is where columns begin and end, the front +z.
Sheet revolve(const std::vector<Ring>& wall, int columns, const Chart& chart) {
  Sheet sheet;
  sheet.columns = columns;
  sheet.rows = static_cast<int>(wall.size()) - 1;
  sheet.position = [&wall, columns](int column, int row) {
    constexpr int kLobes = 18;
    const double angle = kTurn * (column % columns) / columns;
    const Ring& ring = wall[static_cast<std::size_t>(row)];
    const double radius = ring.point.x + ring.lobes * std::cos(kLobes * angle);
    return Vec3d{-radius * std::sin(angle), ring.point.y, -radius * std::cos(angle)};
  };
  sheet.uv = [rows = sheet.rows, columns, chart](int column, int row) {
    return chart.uv(static_cast<double>(column) / columns, static_cast<double>(row) / rows, VaseAtlas::kSize,
                    VaseAtlas::kSize);
  };
  return sheet;
}

/// The underside is laid flat on its chart.
Sheet underside(const std::vector<Ring>& wall, int columns, const Chart& chart) {
  Sheet sheet = revolve(wall, columns, chart);
  sheet.uv = [position = sheet.position, widest = wall.back().point.x, chart](int column, int row) {
    const Vec3d p = position(column, row) * (0.5 / widest);
    return chart.uv(0.5 + p.x, 0.5 + p.z, VaseAtlas::kSize, VaseAtlas::kSize);
  };
  return sheet;
}

/// A bent tube from the neck to the shoulder, closed inside of the wall; `side` is -1 or 1.
Sheet handle(double side, double detail, const Chart& chart) {
  static const Curve kSpine({{0.163, 1.325},
                             {0.230, 1.364},
                             {0.330, 1.365},
                             {0.420, 1.280},
                             {0.440, 1.140},
                             {0.420, 1.030},
                             {0.397, 0.985}});
  Sheet sheet;
  sheet.columns = scaled(20, detail);
  const int length = scaled(64, detail);
  sheet.rows = length + 2;
  const std::vector<Vec2d> points = kSpine.even(0, 6, length);
  sheet.position = [points, side, length, columns = sheet.columns](int column, int row) {
    const int i = std::clamp(row - 1, 0, length);
    const auto at = [&](int k) { return points[static_cast<std::size_t>(std::clamp(k, 0, length))]; };
    const Vec2d along = at(i + 1) - at(i - 1);
    const Vec3d tangent = normalized(Vec3d{along.x, along.y, 0}), across{0, 0, 1};
    const Vec3d outward = cross(across, tangent);
    const bool cap = row == 0 || row == length + 2;
    const double t = static_cast<double>(i) / length, swell = 1 + 0.25 * std::pow(2 * t - 1, 4);
    const double angle = kTurn * (column % columns) / columns;
    const Vec3d offset = outward * (0.020 * std::cos(angle)) + across * (0.032 * std::sin(angle));
    const Vec3d p = Vec3d{at(i).x, at(i).y, 0} + offset * (cap ? 0 : swell);
    return Vec3d{side * p.x, p.y, side * p.z};
  };
  sheet.uv = [rows = sheet.rows, columns = sheet.columns, chart](int column, int row) {
    return chart.uv(static_cast<double>(column) / columns, static_cast<double>(row) / rows, VaseAtlas::kSize,
                    VaseAtlas::kSize);
  };
  return sheet;
}

SplitPart vase_part(const VaseAtlas& atlas, double detail, int material) {
  const int columns = scaled(144, detail);
  const std::vector<Ring> bottom = rings(0, kFoot, scaled(8, detail));
  std::vector<Ring> outside = rings(kFoot, kLipOutside, scaled(118, detail));
  add_lobes(outside);
  const std::vector<Ring> lip = rings(kLipOutside, kLipInside, scaled(8, detail));
  const std::vector<Ring> inside = rings(kLipInside, kFloor, scaled(36, detail));

  SplitPart part = make_part(material);
  add_sheet(part, underside(bottom, columns, atlas.bottom));
  add_sheet(part, revolve(outside, columns, atlas.body));
  add_sheet(part, revolve(lip, columns, atlas.lip));
  add_sheet(part, revolve(inside, columns, atlas.inside));
  add_sheet(part, handle(1, detail, atlas.handles[0]));
  add_sheet(part, handle(-1, detail, atlas.handles[1]));
  add_normals(part);
  return part;
}

}  // namespace

Model make_vase(double detail, Context& context) {
  const VaseAtlas atlas;
  const VaseMeasure measure{kTurn * 0.455, section().length(kFoot, kLipOutside)};
  Model model = empty_model("vase");
  const PaintedMaterial glaze{"glazed", ImageFormat::png, 0.35, false, true};
  const int material = add_material(model, glaze, paint_vase(atlas, measure, context));
  context.advance_or_throw("sample", 0.5);
  add_mesh(model, "vase", {vase_part(atlas, detail, material)}, context);
  return model;
}

}  // namespace fovea::sample
