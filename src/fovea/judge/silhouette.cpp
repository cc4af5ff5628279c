#include "fovea/judge/silhouette.h"

#include <algorithm>
#include <cstdint>

#include "fovea/model/image_error.h"

namespace fovea {

double silhouette_iou(const Image8& coverage_a, const Image8& coverage_b) {
  check_same_shape(coverage_a, coverage_b);
  std::uint64_t both = 0, either = 0;
  for (std::size_t i = 0; i < coverage_a.pixels.size(); ++i) {
    both += std::min(coverage_a.pixels[i], coverage_b.pixels[i]);
    either += std::max(coverage_a.pixels[i], coverage_b.pixels[i]);
  }
  return either > 0 ? static_cast<double>(both) / static_cast<double>(either) : 1;
}

Plane foreground(const Image8& coverage_a, const Image8& coverage_b) {
  check_same_shape(coverage_a, coverage_b);
  Plane mask(coverage_a.width, coverage_a.height);
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    mask.values[i] = coverage_a.pixels[i] > 0 || coverage_b.pixels[i] > 0 ? 1.0f : 0.0f;
  return mask;
}

}  // namespace fovea
