#include "fovea/texture/bake.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/texture/fill.h"
#include "fovea/texture/tangent_frame.h"
#include "fovea/texture/texel_scan.h"

namespace fovea {

namespace {

/// Rows that a thread bakes at once.
constexpr std::size_t kBakedRowGrain = 16;

std::uint8_t byte(float x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0f, 1.0f) * 255 + 0.5f); }

}  // namespace

std::vector<UvSlopes> texel_slopes(std::span<const AtlasFace> to, std::span<const AtlasFace> from, int width,
                                   int height) {
  std::vector<UvSlopes> slopes(to.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Vec2d a = to[i].uv[1] - to[i].uv[0], b = to[i].uv[2] - to[i].uv[0];
    const Vec2d p = from[i].uv[1] - from[i].uv[0], q = from[i].uv[2] - from[i].uv[0];
    const double area = cross(a, b);
    if (area == 0) continue;
    const Vec2d along = (p * b.y - q * a.y) * (1 / (area * width)),
                down = (q * a.x - p * b.x) * (1 / (area * height));
    slopes[i] = {{static_cast<float>(along.x), static_cast<float>(along.y)},
                 {static_cast<float>(down.x), static_cast<float>(down.y)}};
  }
  return slopes;
}

MipMap mip_map(const Image8& image, const TexelMeaning& meaning) {
  return {image, meaning.kind == TexelMeaning::Kind::color ? ColorEncoding::srgb : ColorEncoding::linear};
}

std::vector<Image8> baked(std::span<const BakeSource> sources, const TexelOrigins& origins,
                          std::span<const UvSlopes> slopes, const Context& context) {
  const Sampler sampler = clamping_sampler();
  std::vector<Image8> results;
  for (const BakeSource& source : sources) {
    assert(source.image->width == sources[0].image->width &&
           source.image->height == sources[0].image->height);
    results.emplace_back(origins.width, origins.height, source.image->channels, source.image->encoding);
  }
  const auto bake_texel = [&](int x, int y) {
    const TexelOrigin& origin = origins.texels[origins.index(x, y)];
    const Footprint footprint =
        sources[0].map->footprint(origin.uv, slopes[origin.face], sampler, kBakeAnisotropy);
    for (std::size_t s = 0; s < sources.size(); ++s) {
      Rgba value = sources[s].map->sample(footprint);
      const bool is_color = sources[s].meaning.kind == TexelMeaning::Kind::color;
      const int alpha = results[s].color_channels();
      if (sources[s].meaning.kind == TexelMeaning::Kind::normal && alpha == 3)
        value = turned(value, origin.turn, origin.is_mirrored);
      std::uint8_t* out = results[s].at(x, y);
      const float colors[] = {value.r, value.g, value.b};
      for (int k = 0; k < alpha; ++k) out[k] = is_color ? to_display(colors[k]) : byte(colors[k]);
      if (results[s].has_alpha()) out[alpha] = byte(value.a);
    }
  };
  parallel_for_or_throw(context, static_cast<std::size_t>(origins.height), kBakedRowGrain,
                        [&](std::size_t begin, std::size_t end) {
                          for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                            for (int x = 0; x < origins.width; ++x) {
                              if (origins.drawn[origins.index(x, y)] != 0) bake_texel(x, y);
                            }
                          }
                        });
  fill_undrawn(results, origins.drawn, context);
  return results;
}

std::vector<std::uint8_t> covered_texels(std::span<const AtlasFace> faces, int width, int height,
                                         const Context& context) {
  struct Nothing {};
  const auto nothing = [](std::uint32_t, const std::array<double, 3>&) { return Nothing{}; };
  std::vector<std::uint8_t> covered = rasterized<Nothing>(faces, width, height, nothing, context).drawn;
  std::vector<AtlasFace> thin;
  for (const AtlasFace& face : faces) {
    const auto edge = [&](std::size_t k) {
      const Vec2d d = face.uv[(k + 1) % 3] - face.uv[k];
      return Vec2d{d.x * width, d.y * height};
    };
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, std::hypot(edge(k).x, edge(k).y));
    if (std::abs(cross(edge(0), edge(1))) < longest) thin.push_back(face);
  }
  for_edge_texels(thin, width, height,
                  [&](std::uint32_t, const std::array<double, 3>&, std::size_t t) { covered[t] = 1; });
  return covered;
}

std::vector<std::uint8_t> read_texels(std::span<const AtlasFace> faces, int width, int height,
                                      const Context& context) {
  if (faces.empty()) return {};
  std::vector<std::uint8_t> texels = covered_texels(faces, width, height, context);
  grow_drawn(texels, width, height, context);
  return texels;
}

void fill_between(Image8& image, std::span<const AtlasFace> faces, const Context& context) {
  fill_between({&image, 1}, faces, context);
}

void fill_between(std::span<Image8> images, std::span<const AtlasFace> faces, const Context& context) {
  if (faces.empty()) return;
  std::vector<bool> is_done(images.size());
  for (std::size_t first = 0; first < images.size(); ++first) {
    if (is_done[first]) continue;
    const int width = images[first].width, height = images[first].height;
    std::vector<std::size_t> alike;
    for (std::size_t i = first; i < images.size(); ++i)
      if (images[i].width == width && images[i].height == height) alike.push_back(i);
    std::vector<Image8> together;
    for (const std::size_t i : alike) together.push_back(std::move(images[i]));
    fill_undrawn(together, read_texels(faces, width, height, context), context);
    for (std::size_t k = 0; k < alike.size(); ++k) {
      images[alike[k]] = std::move(together[k]);
      is_done[alike[k]] = true;
    }
  }
}

}  // namespace fovea
