#include "fovea/texture/rebake.h"

#include <algorithm>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/encode.h"
#include "fovea/texture/normal_bake.h"

namespace fovea {

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
  if (origins_.width == width && origins_.height == height) return origins_;
  origins_ = origin_.origins(simplified_, origin_.faces(), width, height, context);
  std::size_t drawn = 0, moved = 0;
  const TexelOrigins own = texel_origins(origin_.faces(), origin_.faces(), {}, width, height, context);
  for (std::size_t i = 0; i < origins_.drawn.size(); ++i) {
    drawn += origins_.drawn[i];
    moved += origins_.drawn[i] != 0 && !(origins_.texels[i].uv == own.texels[i].uv);
  }
  moved_ = drawn > 0 ? static_cast<double>(moved) / static_cast<double>(drawn) : 0;
  return origins_;
}

Image8 AtlasRebake::baked(const Image8& image, const TexelMeaning& meaning, const Context& context) {
  Image8 filled = image;
  fill_between(filled, origin_.original_faces(), context);
  const std::vector<UvSlopes> slopes =
      texel_slopes(origin_.faces(), origin_.faces(), image.width, image.height);
  return fovea::baked(filled, meaning, origins(image.width, image.height, context), slopes, context);
}

Image8 AtlasRebake::baked_normals(const Image8* map, double scale, int width, int height,
                                  const Context& context) {
  if (map == nullptr)
    return fovea::baked_normals(origin_, simplified_, nullptr, scale, width, height, context);
  Image8 filled = *map;
  fill_between(filled, origin_.original_faces(), context);
  return fovea::baked_normals(origin_, simplified_, &filled, scale, width, height, context);
}

double AtlasRebake::likeness(const Image8& before, const Image8& after, const TexelMeaning& meaning,
                             const Context& context) {
  const auto width = static_cast<std::size_t>(after.channels);
  const auto count = static_cast<std::int64_t>(origins(after.width, after.height, context).drawn.size());
  const std::int64_t drawn = std::ranges::count_if(origins_.drawn, [](std::uint8_t d) { return d != 0; });
  // One row of what lies under triangles.
  Image8 was(static_cast<int>(drawn), 1, after.channels, after.encoding), is = was;
  std::size_t out = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto texel = static_cast<std::size_t>(i);
    if (origins_.drawn[texel] == 0) continue;
    std::copy_n(&before.pixels[texel * width], width, &was.pixels[out]);
    std::copy_n(&after.pixels[texel * width], width, &is.pixels[out]);
    out += width;
  }
  if (drawn == 0) return std::numeric_limits<double>::infinity();
  return encoding_psnr(was, is, meaning.kind == TexelMeaning::Kind::color ? Content::colors : Content::data);
}

}  // namespace fovea
