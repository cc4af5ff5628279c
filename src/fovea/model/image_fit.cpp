#include "fovea/model/image_fit.h"

#include <algorithm>
#include <cstddef>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

/// Rows that a thread takes at once.
constexpr std::size_t kGrain = 32;

/// Begin of box `i` of `count` that together hold `size` texels.
int box_begin(int i, int count, int size) {
  return static_cast<int>(static_cast<std::int64_t>(i) * size / count);
}

struct Box2i {
  int left, right, top, bottom;
};

std::uint8_t mean_in(const Box2i& box, const Image8& image, int channel) {
  const auto count = static_cast<std::int64_t>(box.right - box.left) * (box.bottom - box.top);
  std::int64_t sum = count / 2;  // rounds
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) sum += image.at(x, y)[channel];
  }
  return static_cast<std::uint8_t>(sum / count);
}

}  // namespace

Image8 fitted(const Image8& image, std::int64_t most_texels, const Context& context) {
  int factor = 1, width = image.width, height = image.height;
  while (static_cast<std::int64_t>(width) * height > std::max<std::int64_t>(most_texels, 1)) {
    ++factor;
    width = std::max(image.width / factor, 1);
    height = std::max(image.height / factor, 1);
  }
  if (factor == 1) return image;
  Image8 result(width, height, image.channels, image.encoding);
  parallel_for(context, static_cast<std::size_t>(height), kGrain, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) {
        const Box2i box{box_begin(x, width, image.width), box_begin(x + 1, width, image.width),
                        box_begin(y, height, image.height), box_begin(y + 1, height, image.height)};
        for (int k = 0; k < image.channels; ++k) result.at(x, y)[k] = mean_in(box, image, k);
      }
    }
  });
  return result;
}

}  // namespace fovea
