#include "fovea/model/image_error.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "fovea/base/error.h"

namespace fovea {

void check_same_shape(const Image8& a, const Image8& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throw Error(ErrorKind::usage, "images of different size or channels cannot be compared");
}

double mean_squared_error(const Image8& a, const Image8& b, std::span<const float> mask) {
  check_same_shape(a, b);
  const auto channels = static_cast<std::size_t>(a.channels);
  std::uint64_t sum = 0, count = 0;
  for (std::size_t i = 0; i * channels < a.pixels.size(); ++i) {
    if (!mask.empty() && !(mask[i] > 0)) continue;
    for (std::size_t k = i * channels; k < (i + 1) * channels; ++k) {
      const int difference = int{a.pixels[k]} - int{b.pixels[k]};
      sum += static_cast<std::uint64_t>(difference * difference);
    }
    count += channels;
  }
  return count > 0 ? static_cast<double>(sum) / static_cast<double>(count) : 0;
}

double psnr(double mse) {
  return mse > 0 ? 10 * std::log10(255.0 * 255.0 / mse) : std::numeric_limits<double>::infinity();
}

}  // namespace fovea
