#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/context.h"

// Private to texture.

namespace fovea {

/// Sorts keys by their bits from `low_bit` on; keys that agree in these keep their order. About O(#keys) if
/// these numbers are spread over many powers of two, as weights are, or few; parallel. As much memory again
/// as the keys.
void sort_by_high_bits(std::vector<std::uint64_t>& keys, int low_bit, const Context& context);

}  // namespace fovea
