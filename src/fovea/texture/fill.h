#pragma once

#include <cstdint>
#include <span>

#include "fovea/base/context.h"
#include "fovea/model/image.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Gives texels that nothing was drawn to what lies around: for some texels beyond what was drawn each the
/// mean of its neighbours, so that it goes on as it ends; farther away averages over the drawn ones of
/// squares that double in size until there are some, mixed from there on down (push-pull; Gortler et al.
/// 1996, "The Lumigraph"). So filters and compressors find nothing at a chart's border that is not like the
/// chart. Stored values are averaged as they are. `drawn` [height × width] is 0 for texels to fill; nothing
/// happens if all are. Images of one size, at least one, with the same texels. O(#texels), parallel.
void fill_undrawn(std::span<Image8> images, std::span<const std::uint8_t> drawn, const Context& context);
inline void fill_undrawn(Image8& image, std::span<const std::uint8_t> drawn, const Context& context) {
  fill_undrawn({&image, 1}, drawn, context);
}

/// The eight around each drawn texel count as drawn, too. O(#texels), parallel.
void grow_drawn(std::span<std::uint8_t> drawn, int width, int height, const Context& context);

}  // namespace fovea
