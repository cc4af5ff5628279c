#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/sample/builder.h"
#include "fovea/sample/sample.h"
#include "fovea/sample/sheet.h"

namespace fovea {

namespace {

constexpr std::size_t kMostPoints = std::size_t{1} << 26;
constexpr double kRoughness = 0.9;

/// Heights 0 … 1 at the middles of the pixels of a map, or at fewer points.
class Ground {
 public:
  Ground(const ImageF& map, double detail)
      : map_(map), columns_(points(map.width, detail)), rows_(points(map.height, detail)) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// In pixels from the left edge of the map, from its upper edge.
  double x(int column) const { return place(column, columns_, map_.width); }
  double y(int row) const { return place(row, rows_, map_.height); }

  /// The mean over the pixels that the point stands for.
  double height(int column, int row) const {
    const double reach_x = reach(columns_, map_.width), reach_y = reach(rows_, map_.height);
    const auto first = [](double at, double half) {
      return std::max(static_cast<int>(std::ceil(at - half - 0.5)), 0);
    };
    const auto last = [](double at, double half, int size) {
      return std::min(static_cast<int>(std::floor(at + half - 0.5)), size - 1);
    };
    double sum = 0;
    int count = 0;
    for (int j = first(y(row), reach_y); j <= last(y(row), reach_y, map_.height); ++j) {
      for (int i = first(x(column), reach_x); i <= last(x(column), reach_x, map_.width); ++i, ++count)
        sum += static_cast<double>(map_.at(i, j)[0]);
    }
    return sum / count;
  }

 private:
  static int points(int pixels, double detail) {
    return std::max(2, static_cast<int>(std::lround((pixels - 1) * std::sqrt(detail))) + 1);
  }
  static double step(int points, int pixels) { return static_cast<double>(pixels - 1) / (points - 1); }
  static double place(int i, int points, int pixels) { return 0.5 + i * step(points, pixels); }
  /// Half of the step to the next point, one pixel at least: the middle of the nearest is always in it.
  static double reach(int points, int pixels) { return std::max(0.5, step(points, pixels) / 2); }

  const ImageF& map_;
  int columns_, rows_;
};

void check_map(const TerrainMap& map, double detail) {
  if (!(map.width > 0 && std::isfinite(map.width)))
    throw Error(ErrorKind::usage, fmt::format("land cannot be {} m wide", map.width));
  if (!std::isfinite(map.relief))
    throw Error(ErrorKind::usage, fmt::format("land cannot be {} m high", map.relief));
  if (!(detail > 0 && detail <= 1))
    throw Error(ErrorKind::usage, fmt::format("detail {} is out of range for a height map", detail), {},
                "at most 1: a map has no more detail than its pixels");
}

}  // namespace

ImageF decode_heights(std::span<const std::uint8_t> encoded) {
  const ImageF image = decode_deep_image(encoded);
  if (image.width < 2 || image.height < 2)
    throw Error(ErrorKind::unsupported,
                fmt::format("a height map of {} x {} pixels has no surface", image.width, image.height));
  ImageF heights(image.width, image.height, 1, ColorEncoding::linear);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < heights.pixels.size(); ++i) {
    const float* pixel = image.pixels.data() + i * channels;
    if (image.color_channels() == 3 && (pixel[0] != pixel[1] || pixel[1] != pixel[2]))
      throw Error(ErrorKind::unsupported, "the height map is in colour", {},
                  "heights are grey: black is low, white is high");
    heights.pixels[i] = pixel[0];
  }
  return heights;
}

Model make_terrain(const TerrainMap& map, double detail, Context& context) {
  check_map(map, detail);
  const Ground ground(map.heights, detail);
  if (static_cast<std::size_t>(ground.columns()) * static_cast<std::size_t>(ground.rows()) > kMostPoints)
    throw Error(ErrorKind::limit,
                fmt::format("a height map of {} x {} points is too large", ground.columns(), ground.rows()),
                {}, "--detail takes fewer of them");
  context.advance_or_throw("sample", 0);
  const int pixel_width = map.heights.width, pixel_height = map.heights.height;
  const double pixel = map.width / std::max(pixel_width, pixel_height);
  sample::Sheet sheet;
  sheet.columns = ground.columns() - 1;
  sheet.rows = ground.rows() - 1;
  // Rows of a sheet go from the south to the north, those of a map the other way.
  const auto row_of = [&](int row) { return sheet.rows - row; };
  sheet.position = [&](int column, int row) {
    return Vec3d{(ground.x(column) - pixel_width / 2.0) * pixel,
                 ground.height(column, row_of(row)) * map.relief,
                 (ground.y(row_of(row)) - pixel_height / 2.0) * pixel};
  };
  sheet.uv = [&](int column, int row) {
    return Vec2d{ground.x(column) / pixel_width, ground.y(row_of(row)) / pixel_height};
  };
  Model model = sample::empty_model("terrain");
  SplitPart part = sample::make_part(
      sample::add_material(model, {"land", sample::ImageFormat::png, kRoughness}, EncodedImage(map.texture)));
  sample::add_sheet(part, sheet);
  context.advance_or_throw("sample", 0.5);
  sample::add_normals(part);
  sample::add_mesh(model, "terrain", {std::move(part)}, context);
  return model;
}

}  // namespace fovea
