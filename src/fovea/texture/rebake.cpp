#include "fovea/texture/rebake.h"

#include <algorithm>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/encode.h"
#include "fovea/texture/normal_bake.h"

namespace fovea {

namespace {

/// Under no triangle of the simpler surface, and left as it was.
constexpr std::uint8_t kOutside = 2;
/// Texels around what charts newly cover that are filled from there.
constexpr int kMargin = 8;

Vec2f center(const TexelOrigins& origins, int x, int y) {
  return {(static_cast<float>(x) + 0.5f) / static_cast<float>(origins.width),
          (static_cast<float>(y) + 0.5f) / static_cast<float>(origins.height)};
}

/// Which texels lie within a square around those that are set.
std::vector<std::uint8_t> grown(const std::vector<std::uint8_t>& set, int width, int height) {
  const auto along = [](const std::vector<std::uint8_t>& in, std::size_t lines, std::size_t line,
                        std::size_t count, std::size_t step) {
    std::vector<std::uint8_t> out(in.size(), 0);
    for (std::size_t l = 0; l < lines; ++l) {
      for (std::size_t i = 0; i < count; ++i) {
        if (in[l * line + i * step] == 0) continue;
        const std::size_t first = i - std::min<std::size_t>(i, kMargin),
                          last = std::min<std::size_t>(i + kMargin + 1, count);
        for (std::size_t k = first; k < last; ++k) out[l * line + k * step] = 1;
      }
    }
    return out;
  };
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  return along(along(set, h, w, w, 1), w, 1, h, w);
}

}  // namespace

void check_simplified(const Model& original, const Model& simplified) {
  const auto like = [](const Mesh& a, const Mesh& b) {
    return a.surface.parts.size() == b.surface.parts.size();
  };
  if (!std::ranges::equal(original.meshes, simplified.meshes, like) ||
      original.materials.size() != simplified.materials.size() ||
      original.images.size() != simplified.images.size())
    throw Error(ErrorKind::usage, "textures can be baked only from the model that was simplified");
}

AtlasRebake::AtlasRebake(const Model& original, const Atlas& original_atlas, const Model& simplified,
                         const Atlas& atlas)
    : simplified_(simplified), origin_(original, original_atlas, simplified, atlas) {}

const TexelOrigins& AtlasRebake::origins(int width, int height, const Context& context) {
  const auto [at, is_new] = origins_.try_emplace({width, height});
  TexelOrigins& found = at->second;
  if (!is_new) return found;
  found = origin_.origins(width, height, context);
  std::size_t covered = 0, moved = 0;
  const TexelOrigins own = texel_origins(origin_.faces(), origin_.faces(), {}, width, height, context);
  for (std::size_t i = 0; i < own.drawn.size(); ++i) {
    covered += own.drawn[i];
    moved += own.drawn[i] != 0 && !(found.texels[i].uv == own.texels[i].uv);
  }
  moved_ = covered > 0 ? static_cast<double>(moved) / static_cast<double>(covered) : 0;
  keep_beyond(found, context);
  return found;
}

void AtlasRebake::keep_beyond(TexelOrigins& origins, const Context& context) const {
  const int width = origins.width, height = origins.height;
  const std::vector<std::uint8_t> before = covered_texels(origin_.original_faces(), width, height, context);
  std::vector<std::uint8_t> is_new(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) is_new[i] = origins.drawn[i] != 0 && before[i] == 0;
  is_new = grown(is_new, width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = origins.index(x, y);
      if (origins.drawn[i] != 0 || (before[i] == 0 && is_new[i] != 0)) continue;
      origins.texels[i] = {center(origins, x, y), 0};
      origins.drawn[i] = kOutside;
    }
  }
}

Image8 AtlasRebake::baked(const Image8& image, const TexelMeaning& meaning, const Context& context) {
  if (origin_.faces().empty()) return image;  // all of its triangles went
  Image8 filled = image;
  fill_between(filled, origin_.original_faces(), context);
  const std::vector<UvSlopes> slopes =
      texel_slopes(origin_.faces(), origin_.faces(), image.width, image.height);
  const TexelOrigins& from = origins(image.width, image.height, context);
  const MipMap map = mip_map(filled, meaning);
  const BakeSource source{&filled, &map, meaning};
  Image8 result = std::move(fovea::baked({&source, 1}, from, slopes, context)[0]);
  const auto width = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < from.drawn.size(); ++i) {
    if (from.drawn[i] == kOutside) std::copy_n(&image.pixels[i * width], width, &result.pixels[i * width]);
  }
  return result;
}

Image8 AtlasRebake::baked_normals(const Image8* map, double scale, int width, int height,
                                  const Context& context) {
  if (map == nullptr)
    return fovea::baked_normals(origin_, simplified_, nullptr, scale, width, height, context);
  if (origin_.faces().empty()) return *map;
  Image8 filled = *map;
  fill_between(filled, origin_.original_faces(), context);
  return fovea::baked_normals(origin_, simplified_, &filled, scale, width, height, context);
}

double AtlasRebake::likeness(const Image8& before, const Image8& after, const TexelMeaning& meaning,
                             const Context& context) {
  const auto width = static_cast<std::size_t>(after.channels);
  const std::vector<std::uint8_t>& is_drawn = origins(after.width, after.height, context).drawn;
  const std::int64_t drawn = std::ranges::count(is_drawn, 1);
  // One row of what lies under triangles.
  Image8 was(static_cast<int>(drawn), 1, after.channels, after.encoding), is = was;
  std::size_t out = 0;
  for (std::size_t i = 0; i < is_drawn.size(); ++i) {
    if (is_drawn[i] != 1) continue;
    std::copy_n(&before.pixels[i * width], width, &was.pixels[out]);
    std::copy_n(&after.pixels[i * width], width, &is.pixels[out]);
    out += width;
  }
  if (drawn == 0) return std::numeric_limits<double>::infinity();
  return encoding_psnr(was, is, meaning.kind == TexelMeaning::Kind::color ? Content::colors : Content::data);
}

}  // namespace fovea
