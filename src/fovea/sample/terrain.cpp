#include <algorithm>

#include "fovea/sample/builder.h"
#include "fovea/sample/height_map.h"
#include "fovea/sample/sheet.h"
#include "fovea/sample/terrain_paint.h"

namespace fovea {

namespace {

constexpr int kMapSize = 513, kTextureSize = 1024, kDrops = 100'000;
constexpr double kWidth = 10, kRelief = 0.32;  ///< Height 1 of the map in widths.
constexpr double kWater = 0.115;

/// Heights in widths of the map.
Landscape make_landscape(std::uint64_t seed) {
  HeightMap ground = make_mountains(kMapSize, seed);
  HeightMap flow = erode(ground, kDrops, seed);
  for (int y = 0; y < kMapSize; ++y) {
    for (int x = 0; x < kMapSize; ++x) ground.at(x, y) *= kRelief;
  }
  return {std::move(ground), std::move(flow), kWater * kRelief};
}

SplitPart terrain_part(const Landscape& land, double detail, int material) {
  Sheet sheet;
  sheet.columns = sheet.rows = scaled(224, detail);
  const auto fraction = [n = sheet.columns](int i) { return static_cast<double>(i) / n; };
  // Rows run from the south (+z) to the north, so that the land is seen from above.
  sheet.position = [&](int column, int row) {
    const double x = fraction(column), y = 1 - fraction(row);
    const double height = std::max(land.ground.read(x, y), land.water) - land.water;
    return Vec3d{(x - 0.5) * kWidth, height * kWidth, (y - 0.5) * kWidth};
  };
  sheet.uv = [&](int column, int row) { return Vec2d{fraction(column), 1 - fraction(row)}; };
  SplitPart part = make_part(material);
  add_sheet(part, sheet);
  add_normals(part);
  return part;
}

}  // namespace

Model make_terrain(double detail, Context& context) {
  const Landscape land = make_landscape(context.seed);
  context.advance_or_throw("sample", 0.4);
  Model model = empty_model("terrain");
  const PaintedMaterial look{"land", ImageFormat::jpeg, 1.0, true};
  const int material = add_material(model, look, paint_terrain(land, kTextureSize, context.seed, context));
  context.advance_or_throw("sample", 0.8);
  add_mesh(model, "terrain", {terrain_part(land, detail, material)}, context);
  return model;
}

}  // namespace fovea
