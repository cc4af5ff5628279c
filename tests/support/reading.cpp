#include "support/reading.h"

#include "fovea/io/image_codec.h"

namespace fovea::test {

std::string tiny_png() {
  Image8 image(1, 1, 3, ColorEncoding::srgb);
  image.pixels = {255, 255, 255};
  const std::vector<std::uint8_t> png = encode_png(image);
  return {png.begin(), png.end()};
}

}  // namespace fovea::test
