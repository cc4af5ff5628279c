#include "fovea/budget/wavelet.h"
#include "fuzz/fuzz_model.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::int64_t kMostPixels = 1 << 14;
  fuzz::expect_answer([&] { reconstructed(decode_wavelets({data, size}, kMostPixels)); });
  return 0;
}
