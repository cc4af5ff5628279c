#include <algorithm>
#include <array>

#include "fovea/sample/builder.h"
#include "fovea/sample/height_map.h"
#include "fovea/sample/sheet.h"
#include "fovea/sample/terrain_paint.h"

namespace fovea::sample {

namespace {

constexpr int kMapSize = 513, kDrops = 100'000;
constexpr double kWidth = 10, kRelief = 0.32;    ///< Height 1 of the map in widths.
constexpr double kWater = 0.115, kEarth = 0.06;  ///< Earth below the water, in widths.

/// Heights in widths of the map.
Landscape make_landscape(std::uint64_t seed) {
  HeightMap ground = make_mountains(kMapSize, seed);
  HeightMap flow = erode(ground, kDrops, seed);
  for (int y = 0; y < kMapSize; ++y) {
    for (int x = 0; x < kMapSize; ++x) ground.at(x, y) *= kRelief;
  }
  const double water = kWater * kRelief;
  double crest = water;
  constexpr int kLast = kMapSize - 1;
  for (int i = 0; i <= kLast; ++i) {
    crest = std::max({crest, ground.at(i, 0), ground.at(i, kLast), ground.at(0, i), ground.at(kLast, i)});
  }
  return {std::move(ground), std::move(flow), water, water - kEarth, crest};
}

/// The surface of the block over a square grid of points: columns from west to east, rows from the south
/// (+z) to the north, so that the land is seen from above.
class Block {
 public:
  Block(const Landscape& land, const TerrainAtlas& atlas, double detail)
      : land_(land), atlas_(atlas), cells_(scaled(200, detail)), layers_(scaled(10, detail)) {}

  SplitPart part(int material) const {
    SplitPart part = make_part(material);
    add_sheet(part, top());
    add_normals(part);
    constexpr Vec3f kOutward[] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
    for (const int number : {0, 1, 2, 3}) add_flat(part, side(number), kOutward[number]);
    add_flat(part, bottom(), {0, -1, 0});
    return part;
  }

 private:
  /// A point of the grid.
  struct Point {
    int column, row;
  };

  Sheet top() const {
    Sheet sheet;
    sheet.columns = sheet.rows = cells_;
    sheet.position = [this](int column, int row) { return surface({column, row}); };
    sheet.uv = [this](int column, int row) { return atlas_uv(atlas_.top, fraction(column), fraction(row)); };
    return sheet;
  }

  /// Sides are numbered from the south through the east, each from left to right.
  Sheet side(int number) const {
    Sheet sheet;
    sheet.columns = cells_;
    sheet.rows = layers_;
    sheet.position = [this, number](int column, int row) {
      const Vec3d rim = surface(rim_point(number * cells_ + column));
      // The uppermost row meets the top bit by bit.
      return row == layers_ ? rim : Vec3d{rim.x, mix(base(), rim.y, layer(row)), rim.z};
    };
    sheet.uv = [this, number, position = sheet.position](int column, int row) {
      const double crest = (land_.crest - land_.water) * kWidth;
      const double t = (position(column, row).y - base()) / (crest - base());
      return atlas_uv(atlas_.sides[number / 2], (number % 2 + fraction(column)) / 2, t);
    };
    return sheet;
  }

  /// A fan around the middle.
  Sheet bottom() const {
    Sheet sheet;
    sheet.columns = 4 * cells_;
    sheet.rows = 1;
    sheet.position = [this](int column, int row) {
      const Vec3d rim = surface(rim_point(column));
      return row == 0 ? Vec3d{0, base(), 0} : Vec3d{rim.x, base(), rim.z};
    };
    sheet.uv = [this, position = sheet.position](int column, int row) {
      const Vec3d p = position(column, row) * (1 / kWidth);
      return atlas_uv(atlas_.bottom, 0.5 + p.x, 0.5 + p.z);
    };
    return sheet;
  }

  static void add_flat(SplitPart& part, const Sheet& sheet, Vec3f normal) {
    const std::size_t first = add_sheet(part, sheet);
    std::vector<float>& normals = find_attribute(part, Semantic::normal)->values;
    for (std::size_t v = first; v < part.positions.size(); ++v) {
      normals.insert(normals.end(), {normal.x, normal.y, normal.z});
    }
  }

  Vec3d surface(Point at) const {
    const double x = fraction(at.column), y = 1 - fraction(at.row);
    const double height = std::max(land_.ground.read(x, y), land_.water) - land_.water;
    return {(x - 0.5) * kWidth, height * kWidth, (y - 0.5) * kWidth};
  }

  /// The grid's points along its rim, counter-clockwise from the south-west.
  Point rim_point(int i) const {
    const int n = cells_, along = i % n;
    const std::array<Point, 4> points = {{{along, 0}, {n, along}, {n - along, n}, {0, n - along}}};
    return points[static_cast<std::size_t>(i / n % 4)];
  }

  static Vec2d atlas_uv(const Chart& chart, double s, double t) {
    return chart.uv(s, t, TerrainAtlas::kWidth, TerrainAtlas::kHeight);
  }
  double fraction(int i) const { return static_cast<double>(i) / cells_; }
  double layer(int row) const { return static_cast<double>(row) / layers_; }
  double base() const { return (land_.base - land_.water) * kWidth; }

  const Landscape& land_;
  const TerrainAtlas& atlas_;
  int cells_, layers_;
};

}  // namespace

Model make_terrain(double detail, Context& context) {
  const Landscape land = make_landscape(context.seed);
  const TerrainAtlas atlas;
  context.advance_or_throw("sample", 0.4);
  Model model = empty_model("terrain");
  const int material = add_material(model, {"land", ImageFormat::jpeg, 1.0},
                                    paint_terrain(land, atlas, context.seed, context));
  context.advance_or_throw("sample", 0.8);
  add_mesh(model, "terrain", {Block(land, atlas, detail).part(material)}, context);
  return model;
}

}  // namespace fovea::sample
