#include "fovea/saliency/texture_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/saliency/texel_scan.h"
#include "fovea/saliency/uv_map.h"

namespace fovea {

namespace {

constexpr int kLongestSide = 4096;
/// Texels that a map goes on beyond charts, so that filters find nothing else there.
constexpr int kGutter = 4;
/// Texels of a triangle along an axis; what repeats more often is cut there, as it only repeats.
constexpr double kMostTexels = 4 * kLongestSide;

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
    for_texel_rows(triangle.texel, 1, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
      const int row = wrapped_texel(y, height_, sampler.wrap_v);
      for (std::int64_t x = begin; x < end; ++x) {
        put(wrapped_texel(x, width_, sampler.wrap_u), row,
            triangle.at(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5));
      }
    });
    // Triangles between texel centres leave their mark as well.
    for (std::size_t k = 0; k < 3; ++k) {
      put(wrapped_texel(static_cast<std::int64_t>(std::floor(triangle.texel[k].x)), width_, sampler.wrap_u),
          wrapped_texel(static_cast<std::int64_t>(std::floor(triangle.texel[k].y)), height_, sampler.wrap_v),
          triangle.value[k]);
    }
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

/// Draws one part of a mesh.
void draw_part(const TriMesh& mesh, std::size_t part, const UvMap& map, const VertexField& field,
               const Sampler& sampler, Canvas& canvas) {
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_part[f] != part) continue;
    const auto uv = map.triangle(f);
    if (!uv) continue;
    FieldTriangle triangle;
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.texel[k] = {(*uv)[k].x * canvas.width(), (*uv)[k].y * canvas.height()};
      triangle.value[k] = field[mesh.triangles[f][k]];
      extent = std::max({extent, std::abs(triangle.texel[k].x - triangle.texel[0].x),
                         std::abs(triangle.texel[k].y - triangle.texel[0].y)});
    }
    if (extent <= kMostTexels) canvas.draw(triangle, sampler);
  }
}

}  // namespace

std::vector<TextureSpaceMap> texture_space_maps(const Model& model, const std::vector<VertexField>& fields,
                                                Context& context) {
  std::map<int, Canvas> canvases;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const TriMesh& mesh = model.meshes[m].surface;
    for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
      context.advance_or_throw("texture map",
                               static_cast<double>(m) / static_cast<double>(model.meshes.size()));
      if (mesh.parts[p].raw || mesh.parts[p].material < 0) continue;
      const auto& ref = model.materials[static_cast<std::size_t>(mesh.parts[p].material)].base_color;
      if (!ref || ref->texture < 0) continue;
      const Texture& texture = model.textures[static_cast<std::size_t>(ref->texture)];
      const UvMap map(mesh, *ref);
      if (texture.image < 0 || map.layer == nullptr) continue;
      if (!canvases.contains(texture.image)) {
        const EncodedImage& image = model.images[static_cast<std::size_t>(texture.image)];
        canvases.emplace(texture.image, canvas_for(image, texture.image));
      }
      const Sampler sampler =
          texture.sampler >= 0 ? model.samplers[static_cast<std::size_t>(texture.sampler)] : Sampler{};
      draw_part(mesh, p, map, fields[m], sampler, canvases.at(texture.image));
    }
  }
  if (canvases.empty())
    throw Error(ErrorKind::usage, "no triangle has a texture as its base colour", {},
                "there is no texture space to draw a map in");
  std::vector<TextureSpaceMap> maps;
  for (auto& [image, canvas] : canvases) {
    for (int i = 0; i < kGutter; ++i) canvas.grow();
    maps.push_back({image, canvas.image()});
  }
  return maps;
}

}  // namespace fovea
