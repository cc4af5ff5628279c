#include "fovea/io/image_codec.h"

#include "fuzz/fuzz_model.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expect_answer([&] {
    const std::span<const std::uint8_t> bytes(data, size);
    const ImageInfo info = image_info(bytes);
    const Image8 image = decode_image(bytes, std::int64_t{1} << 18);
    // The header says how large an image is before it is decoded, for limits.
    if (info.width != image.width || info.height != image.height) std::abort();
  });
  return 0;
}
