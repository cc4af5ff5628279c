#include "fovea/saliency/texture_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/check_fields.h"
#include "fovea/model/texture_use.h"
#include "fovea/texture/texel_canvas.h"
#include "fovea/texture/uv_map.h"

namespace fovea {

namespace {

constexpr int kLongestSide = 4096;
/// Texels that a map goes on beyond charts, so that filters find nothing else there.
constexpr int kGutter = 4;
/// What a triangle covers along an axis, in texels and in repeats of the image: one that covers more is
/// shrunk to that, so that small images cost little.
constexpr double kMostTexels = 4 * kLongestSide, kMostRepeats = 16;

using Canvas = TexelCanvas<float>;

float larger(float a, float b) { return std::max(a, b); }

/// An empty canvas of an image's size, or less where that is too much.
Canvas canvas_for(const EncodedImage& image, int number) {
  const ImageInfo info = image_info(image.bytes);
  if (info.width <= 0 || info.height <= 0)
    throw Error(ErrorKind::unsupported, "the size of this image is not known",
                fmt::format("/images/{}", number));
  const int divisor = (std::max(info.width, info.height) + kLongestSide - 1) / kLongestSide;
  return {std::max(info.width / divisor, 1), std::max(info.height / divisor, 1)};
}

Image8 image_of(const Canvas& canvas) {
  Image8 result(canvas.width(), canvas.height(), 1, ColorEncoding::linear);
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const float value = canvas.at(x, y) > 0 ? std::min(canvas.at(x, y), 1.0f) : 0;
      *result.at(x, y) = static_cast<std::uint8_t>(std::lround(255 * value));
    }
  }
  return result;
}

/// How far a triangle is shrunk along an axis of `size` texels.
double shrink(double a, double b, double c, int size) {
  const double extent = std::max({a, b, c}) - std::min({a, b, c});
  const double most = std::min(kMostTexels, kMostRepeats * size);
  return extent > most ? most / extent : 1;
}

/// How the triangles of a part lie in the image that is their base colour.
struct PartPlace {
  int image;
  UvMap map;
  Sampler sampler;
};

/// None if they have no place in one.
std::optional<PartPlace> place_of(const Model& model, const TriMesh& mesh, const Part& part) {
  if (part.raw) return {};
  const std::optional<TextureUse> use = resolve(model, material_of(model, part).base_color);
  if (!use) return {};
  const UvMap map(mesh, *use);
  if (map.layer == nullptr) return {};
  return PartPlace{use->image, map, use->sampler};
}

/// Those of the parts in one image [#parts].
std::vector<std::optional<PartPlace>> places(const Model& model, const TriMesh& mesh, int image) {
  std::vector<std::optional<PartPlace>> result;
  for (const Part& part : mesh.parts) {
    auto& place = result.emplace_back(place_of(model, mesh, part));
    if (place && place->image != image) place.reset();
  }
  return result;
}

void draw_face(const TriMesh& mesh, std::uint32_t face, const PartPlace& place, const VertexField& field,
               Canvas& canvas) {
  const auto uv = place.map.triangle(face);
  if (!uv) return;
  std::array<Vec2d, 3> texel;
  std::array<double, 3> value{};
  for (std::size_t k = 0; k < 3; ++k) {
    texel[k] = {(*uv)[k].x * canvas.width(), (*uv)[k].y * canvas.height()};
    value[k] = static_cast<double>(field[mesh.triangles[face][k]]);
  }
  const double x = shrink(texel[0].x, texel[1].x, texel[2].x, canvas.width()),
               y = shrink(texel[0].y, texel[1].y, texel[2].y, canvas.height());
  for (std::size_t k = 1; k < 3; ++k)
    texel[k] = {texel[0].x + x * (texel[k].x - texel[0].x), texel[0].y + y * (texel[k].y - texel[0].y)};
  const auto value_at = [&](const std::array<double, 3>& weights) {
    return static_cast<float>(weights[0] * value[0] + weights[1] * value[1] + weights[2] * value[2]);
  };
  canvas.draw(texel, place.sampler, value_at, larger);
}

}  // namespace

std::vector<int> texture_space_images(const Model& model) {
  std::set<int> images;
  for (const Mesh& mesh : model.meshes) {
    const TriMesh& surface = mesh.surface;
    std::vector<bool> used(surface.parts.size(), false);
    for (const std::uint32_t part : surface.face_part) used[part] = true;
    for (std::size_t p = 0; p < used.size(); ++p) {
      const auto place = used[p] ? place_of(model, surface, surface.parts[p]) : std::nullopt;
      if (place) images.insert(place->image);
    }
  }
  if (images.empty())
    throw Error(ErrorKind::unsupported, "no triangle has a texture as its base colour", {},
                "there is no texture space to draw a map in");
  return {images.begin(), images.end()};
}

Image8 texture_space_map(const Model& model, const std::vector<VertexField>& fields, int image,
                         Context& context) {
  constexpr std::uint32_t kFacesAtOnce = 1 << 8;  // between two looks whether to go on
  check_fields(model, fields);
  Canvas canvas = canvas_for(model.images[static_cast<std::size_t>(image)], image);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const TriMesh& mesh = model.meshes[m].surface;
    const std::vector<std::optional<PartPlace>> place = places(model, mesh, image);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
      if (f % kFacesAtOnce == 0)
        context.advance_or_throw("texture map",
                                 static_cast<double>(m) / static_cast<double>(model.meshes.size()));
      if (place[mesh.face_part[f]]) draw_face(mesh, f, *place[mesh.face_part[f]], fields[m], canvas);
    }
  }
  canvas.grow(kGutter, larger);
  return image_of(canvas);
}

}  // namespace fovea
