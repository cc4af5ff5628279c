#include "support/pictures.h"

#include <algorithm>

#include "fovea/base/random.h"

namespace fovea::test {

Image8 pattern(int width, int height) {
  Image8 image(width, height, 3, ColorEncoding::srgb);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* p = image.at(x, y);
      p[0] = static_cast<std::uint8_t>((3 * x + y) % 256);
      p[1] = static_cast<std::uint8_t>((x / 16 + y / 16) % 2 * 180 + 40);
      p[2] = static_cast<std::uint8_t>((x * x + y * y) / 97 % 256);
    }
  }
  return image;
}

Image8 distorted(const Image8& image) {
  Image8 result = image;
  Random random(1);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int from = x >= image.width / 2 ? std::max(x - 2, 0) : x;
      for (int k = 0; k < 3; ++k) {
        int value = image.at(from, y)[k];
        if (y >= image.height / 2) value += static_cast<int>(random.below(25)) - 12;
        if (x >= 20 && x < 40 && y >= 20 && y < 40) value = 255 - value;
        result.at(x, y)[k] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
      }
    }
  }
  return result;
}

Image8 even(int size, std::uint8_t value) {
  Image8 image(size, size, 3, ColorEncoding::srgb);
  std::ranges::fill(image.pixels, value);
  return image;
}

}  // namespace fovea::test
