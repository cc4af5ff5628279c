#include "sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"

namespace fovea::cli {

namespace {

/// Along a side of a sheet: what common viewers still open.
constexpr std::int64_t kMostPixels = 1 << 16;

/// In the background's colour.
Image8 empty_sheet(std::size_t views, std::int64_t columns, const RenderOptions& options) {
  const auto count = static_cast<std::int64_t>(views);
  const auto square = static_cast<std::int64_t>(std::ceil(std::sqrt(1.5 * static_cast<double>(count))));
  const std::int64_t across = std::clamp(columns > 0 ? columns : square, std::int64_t{1}, count);
  const std::int64_t width = across * options.width, height = (count + across - 1) / across * options.height;
  if (std::max(width, height) > kMostPixels) {
    throw Error(ErrorKind::usage,
                fmt::format("the sheet would have more than {} pixels along a side", kMostPixels), {},
                "make the views smaller or fewer");
  }
  Image8 sheet(static_cast<int>(width), static_cast<int>(height), 3, ColorEncoding::srgb);
  for (std::size_t i = 0; i < sheet.pixels.size(); ++i) sheet.pixels[i] = options.background[i % 3];
  return sheet;
}

/// Puts a picture at a place of the sheet, counted row by row.
void put(const Image8& picture, std::size_t place, Image8& sheet) {
  const int columns = sheet.width / picture.width, at = static_cast<int>(place);
  for (int y = 0; y < picture.height; ++y) {
    std::copy_n(picture.at(0, y), 3 * picture.width,
                sheet.at(at % columns * picture.width, at / columns * picture.height + y));
  }
}

}  // namespace

Image8 draw_sheet(const RenderScene& scene, std::span<const View> views, std::int64_t columns,
                  const RenderOptions& options, Context& context, std::span<const VertexField> fields) {
  Image8 sheet = empty_sheet(views.size(), columns, options);
  const auto at_once = static_cast<std::size_t>(context.thread_count());
  for (std::size_t i = 0; i < views.size(); i += at_once) {
    context.advance_or_throw("draw", static_cast<double>(i) / static_cast<double>(views.size()));
    const std::span<const View> next = views.subspan(i, std::min(at_once, views.size() - i));
    const std::vector<Picture> pictures = render_views(scene, next, options, context, fields);
    for (std::size_t k = 0; k < pictures.size(); ++k) put(pictures[k].color, i + k, sheet);
  }
  return sheet;
}

Image8 join_sheet(std::span<const Image8> pictures, std::int64_t columns) {
  RenderOptions options;
  options.width = pictures.front().width;
  options.height = pictures.front().height;
  Image8 sheet = empty_sheet(pictures.size(), columns, options);
  for (std::size_t i = 0; i < pictures.size(); ++i) put(pictures[i], i, sheet);
  return sheet;
}

}  // namespace fovea::cli
