#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/texture/mip_map.h"
#include "fovea/texture/resize.h"
#include "fovea/texture/texel_origin.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Looks at most along the longer side of what a texel covers.
inline constexpr int kBakeAnisotropy = 4;

/// How a triangle's place in the old image changes from a texel of the new one to the next.
std::vector<UvSlopes> texel_slopes(std::span<const AtlasFace> to, std::span<const AtlasFace> from, int width,
                                   int height);

/// The copies of an image that `baked` looks at.
MipMap mip_map(const Image8& image, const TexelMeaning& meaning);

/// An image that is baked, and its `mip_map`.
struct BakeSource {
  const Image8* image = nullptr;
  const MipMap* map = nullptr;
  TexelMeaning meaning;
};

/// Images of one size as they look through triangles that have moved: each texel of the new ones is looked up
/// where it comes from, as GPUs filter (`MipMap`, `kBakeAnisotropy`).
/// Normal maps turn with their tangents. What no triangle covers goes on from what is around
/// (`fill_undrawn`).
///
/// `slopes` [#faces of `origins`]. The results have the size of `origins`. O(#texels of all), parallel.
/// Throws Error(cancelled).
std::vector<Image8> baked(std::span<const BakeSource> sources, const TexelOrigins& origins,
                          std::span<const UvSlopes> slopes, const Context& context);

/// 1 for texels that triangles show: those whose centre lies in one, and those along triangles that are less
/// than a texel high. [height × width]. O(#F + #texels), parallel.
std::vector<std::uint8_t> covered_texels(std::span<const AtlasFace> faces, int width, int height,
                                         const Context& context);

/// 1 for texels that pictures read: those that are covered and the eight around each. [height × width];
/// empty, for all, without triangles. O(#F + #texels), parallel.
std::vector<std::uint8_t> read_texels(std::span<const AtlasFace> faces, int width, int height,
                                      const Context& context);

/// The image with all that no triangle covers (`covered_texels`) filled from what is around, its colours
/// beyond the triangles' borders among them; but for the texels beside those that are covered, which are
/// mixed into what shows. In place. O(#F + #texels), parallel.
void fill_between(Image8& image, std::span<const AtlasFace> faces, const Context& context);
/// The same for several, of any sizes; what triangles cover is found once for each size.
void fill_between(std::span<Image8> images, std::span<const AtlasFace> faces, const Context& context);

}  // namespace fovea
