#include "fovea/saliency/texture_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/check_fields.h"
#include "fovea/saliency/texel_scan.h"
#include "fovea/saliency/uv_map.h"

namespace fovea {

namespace {

constexpr int kLongestSide = 4096;
/// Texels that a map goes on beyond charts, so that filters find nothing else there.
constexpr int kGutter = 4;
/// What a triangle covers along an axis, in texels and in repeats of the image: one that covers more is
/// shrunk to that, so that small images cost little.
constexpr double kMostTexels = 4 * kLongestSide, kMostRepeats = 16;

/// The corners of a triangle in the texture and the field there.
struct FieldTriangle {
  std::array<Vec2d, 3> texel;
  std::array<float, 3> value{};

  float at(double x, double y) const {
    const Vec2d a = texel[1] - texel[0], b = texel[2] - texel[0], p = Vec2d{x, y} - texel[0];
    const double area = a.x * b.y - a.y * b.x;
    const double u = area != 0 ? std::clamp((p.x * b.y - p.y * b.x) / area, 0.0, 1.0) : 0;
    const double v = area != 0 ? std::clamp((a.x * p.y - a.y * p.x) / area, 0.0, 1.0 - u) : 0;
    return static_cast<float>((1 - u - v) * static_cast<double>(value[0]) +
                              u * static_cast<double>(value[1]) + v * static_cast<double>(value[2]));
  }
};

/// A map that triangles are drawn into.
class Canvas {
 public:
  Canvas(int width, int height) : width_(width), height_(height), values_(size(), -1.0f) {}

  void draw(const FieldTriangle& triangle, const Sampler& sampler) {
    bool drawn = false;
    for_texel_rows(triangle.texel, 1, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
      const int row = wrapped_texel(y, height_, sampler.wrap_v);
      drawn = true;
      for (std::int64_t x = begin; x < end; ++x) {
        put(wrapped_texel(x, width_, sampler.wrap_u), row,
            triangle.at(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5));
      }
    });
    if (drawn) return;
    // Triangles between texel centres leave their mark as well.
    const Vec2d middle = (triangle.texel[0] + triangle.texel[1] + triangle.texel[2]) * (1.0 / 3);
    put(wrapped_texel(static_cast<std::int64_t>(std::floor(middle.x)), width_, sampler.wrap_u),
        wrapped_texel(static_cast<std::int64_t>(std::floor(middle.y)), height_, sampler.wrap_v),
        (triangle.value[0] + triangle.value[1] + triangle.value[2]) / 3);
  }

  void grow() {
    const std::vector<float> before = values_;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (before[index(x, y)] >= 0) continue;
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const int nx = x + dx, ny = y + dy;
          if (nx >= 0 && ny >= 0 && nx < width_ && ny < height_) put(x, y, before[index(nx, ny)]);
        }
      }
    }
  }

  Image8 image() const {
    Image8 result(width_, height_, 1, ColorEncoding::linear);
    for (std::size_t i = 0; i < values_.size(); ++i)
      result.pixels[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(values_[i], 0.0f, 1.0f)));
    return result;
  }

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  std::size_t size() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void put(int x, int y, float value) {
    float& there = values_[index(x, y)];
    there = std::max(there, value);
  }

  int width_, height_;
  std::vector<float> values_;  // below 0 where nothing is
};

/// An empty canvas of an image's size, or less where that is too much.
Canvas canvas_for(const EncodedImage& image, int number) {
  const ImageInfo info = image_info(image.bytes);
  if (info.width <= 0 || info.height <= 0)
    throw Error(ErrorKind::unsupported, "the size of this image is not known",
                fmt::format("/images/{}", number));
  const int divisor = (std::max(info.width, info.height) + kLongestSide - 1) / kLongestSide;
  return {std::max(info.width / divisor, 1), std::max(info.height / divisor, 1)};
}

/// How far a triangle is shrunk along an axis of `size` texels.
double shrink(double a, double b, double c, int size) {
  const double extent = std::max({a, b, c}) - std::min({a, b, c});
  const double most = std::min(kMostTexels, kMostRepeats * size);
  return extent > most ? most / extent : 1;
}

/// The texture that is a part's base colour; none if its triangles have no place in one.
const TextureRef* base_color(const Model& model, const TriMesh& mesh, const Part& part) {
  if (part.raw || part.material < 0) return nullptr;
  const auto& ref = model.materials[static_cast<std::size_t>(part.material)].base_color;
  if (!ref || ref->texture < 0 || UvMap(mesh, *ref).layer == nullptr) return nullptr;
  return model.textures[static_cast<std::size_t>(ref->texture)].image >= 0 ? &*ref : nullptr;
}

/// How the triangles of a part lie in the image that is drawn.
struct PartPlace {
  UvMap map;
  Sampler sampler;
};

/// [#parts]; none for those that lie elsewhere.
std::vector<std::optional<PartPlace>> places(const Model& model, const TriMesh& mesh, int image) {
  std::vector<std::optional<PartPlace>> result(mesh.parts.size());
  for (std::size_t p = 0; p < result.size(); ++p) {
    const TextureRef* const ref = base_color(model, mesh, mesh.parts[p]);
    if (ref == nullptr) continue;
    const Texture& texture = model.textures[static_cast<std::size_t>(ref->texture)];
    if (texture.image != image) continue;
    result[p] = {UvMap(mesh, *ref), {}};
    if (texture.sampler >= 0) result[p]->sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
  }
  return result;
}

void draw_face(const TriMesh& mesh, std::uint32_t face, const PartPlace& place, const VertexField& field,
               Canvas& canvas) {
  const auto uv = place.map.triangle(face);
  if (!uv) return;
  FieldTriangle triangle;
  auto& texel = triangle.texel;
  for (std::size_t k = 0; k < 3; ++k) {
    texel[k] = {(*uv)[k].x * canvas.width(), (*uv)[k].y * canvas.height()};
    triangle.value[k] = field[mesh.triangles[face][k]];
  }
  const double x = shrink(texel[0].x, texel[1].x, texel[2].x, canvas.width()),
               y = shrink(texel[0].y, texel[1].y, texel[2].y, canvas.height());
  for (std::size_t k = 1; k < 3; ++k)
    texel[k] = {texel[0].x + x * (texel[k].x - texel[0].x), texel[0].y + y * (texel[k].y - texel[0].y)};
  canvas.draw(triangle, place.sampler);
}

}  // namespace

std::vector<int> texture_space_images(const Model& model) {
  std::set<int> images;
  for (const Mesh& mesh : model.meshes) {
    const TriMesh& surface = mesh.surface;
    std::vector<bool> used(surface.parts.size(), false);
    for (const std::uint32_t part : surface.face_part) used[part] = true;
    for (std::size_t p = 0; p < used.size(); ++p) {
      const TextureRef* const ref = used[p] ? base_color(model, surface, surface.parts[p]) : nullptr;
      if (ref != nullptr) images.insert(model.textures[static_cast<std::size_t>(ref->texture)].image);
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
  for (int i = 0; i < kGutter; ++i) canvas.grow();
  return canvas.image();
}

}  // namespace fovea
