#include <cmath>
#include <numbers>

#include "fovea/base/random.h"
#include "fovea/sample/builder.h"
#include "fovea/sample/sheet.h"
#include "fovea/sample/spheres_paint.h"

namespace fovea::sample {

namespace {

// The spheres touch but for a hundredth of their radius.
constexpr double kRadius = 1, kGap = 0.01 * kRadius;
constexpr Vec3d kLeft{-kRadius - kGap / 2, 0, 0}, kRight{kRadius + kGap / 2, 0, 0};

/// The whole number i of 0 … n as one of -1 … 1 that is exact at the ends and symmetric.
double centred(int i, int n) { return static_cast<double>(2 * i - n) / n; }

SplitPart sphere(Vec3d center, int quads, const CubeAtlas& atlas, int material) {
  SplitPart part = make_part(material);
  for (int side = 0; side < 6; ++side) {
    Sheet sheet;
    sheet.columns = sheet.rows = quads;
    sheet.position = [&](int column, int row) {
      const Vec3d d = cube_direction(side, centred(column, quads), centred(row, quads));
      return center + normalized(d) * kRadius;
    };
    sheet.uv = [&, chart = atlas.side(side)](int column, int row) {
      return chart.uv(static_cast<double>(column) / quads, static_cast<double>(row) / quads,
                      CubeAtlas::kWidth, CubeAtlas::kHeight);
    };
    add_sheet(part, sheet);
  }
  add_normals(part);
  return part;
}

/// Directions in which the sphere swells: spread evenly (Fibonacci lattice), then shaken.
std::vector<Vec3d> bump_directions(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3d> directions;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - 2 * (i + 0.5) / count, r = std::sqrt(1 - y * y);
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Vec3d shake{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    directions.push_back(normalized(Vec3d{r * std::cos(angle), y, r * std::sin(angle)} + shake * 0.15));
  }
  return directions;
}

/// How far the right sphere swells in a direction: less than to the middle of the gap between both.
double swelling(Vec3d d, const std::vector<Vec3d>& bumps) {
  constexpr double kHeight = 0.20 * kRadius, kWidth = 0.24;
  double sum = 0;
  for (const Vec3d& b : bumps) {
    const double angle = std::acos(std::min(1.0, std::max(-1.0, dot(d, b)))) / kWidth;
    sum += std::exp(-angle * angle);
  }
  const double free = kHeight * sum, room = 0.8 * kRadius * (1 + d.x);
  return free * room / (free + room);
}

void add_bumps(SplitPart& part, Vec3d center, std::uint64_t seed) {
  const std::vector<Vec3d> bumps = bump_directions(36, seed);
  std::vector<Vec3f> moves, moved;
  for (const Vec3f& p : part.positions) {
    const Vec3d d = normalized(Vec3d(p) - center);
    moves.push_back(Vec3f(d * swelling(d, bumps)));
    moved.push_back(p + moves.back());
  }
  VertexArray turns = *find_attribute(part, Semantic::normal);
  const std::vector<float> normals = smooth_normals(part, moved);
  for (std::size_t i = 0; i < normals.size(); ++i) turns.values[i] = normals[i] - turns.values[i];
  part.position_morphs = {std::move(moves)};
  part.attribute_morphs = {{std::move(turns)}};
}

}  // namespace

Model make_spheres(double detail, Context& context) {
  const CubeAtlas atlas;
  Model model = empty_model("spheres");
  const int giant =
      add_material(model, {"gas giant", ImageFormat::jpeg, 0.8}, paint_gas_giant(atlas, context));
  context.advance_or_throw("sample", 0.4);
  const int earth = add_material(model, {"earth", ImageFormat::jpeg, 0.6}, paint_earth(atlas, context));
  context.advance_or_throw("sample", 0.8);

  const int quads = scaled(41, detail);
  SplitPart still = sphere(kLeft, quads, atlas, giant), changing = sphere(kRight, quads, atlas, earth);
  add_bumps(changing, kRight, context.seed);
  still.position_morphs.resize(1);  // glTF wants as many targets in every part.
  still.attribute_morphs.resize(1);
  const int node = add_mesh(model, "spheres", {still, changing}, context);
  model.meshes[0].json = R"({"extras":{"targetNames":["bumps"]}})";
  add_animation(model, "swell", node, "weights", {0, 1.5f, 3}, {0, 1, 0}, 1);
  return model;
}

}  // namespace fovea::sample
