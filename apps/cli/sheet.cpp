#include "sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fovea/base/error.h"
#include "shared_options.h"

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

ViewOptions views_around() {
  ViewOptions views;
  views.set = ViewSet::orbit;
  views.count = 6;
  return views;
}

void add_sheet(Arguments& arguments, SheetOptions& sheet, std::function<bool()> is_picture) {
  arguments.add("Picture", describe(sheet.views));
  arguments.add("Picture", {describe_view_size(sheet.size), describe_columns(sheet.columns)});
  need_views(arguments, sheet.views);
  arguments.need({{"views", "view-count", "elevation", "fov", "margin", "view-size", "columns"},
                  "a picture as output",
                  std::move(is_picture),
                  "name it .png, .jpg or .webp"});
}

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

Image8 draw_sheet(const Model& model, const PoseOptions& pose_options, const SheetOptions& sheet,
                  RenderOptions options, Context& context, std::span<const VertexField> fields) {
  options.width = options.height = sheet.size;
  const Pose pose = pose_of(model, pose_options);
  const RenderScene scene = make_render_scene(model, pose, context);
  const std::vector<View> views = views_of(sheet.views, model, pose, scene.sphere);
  return draw_sheet(scene, views, sheet.columns, options, context, fields);
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
