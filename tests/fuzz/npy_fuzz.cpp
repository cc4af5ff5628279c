#include "fovea/io/field_file.h"

#include "fuzz/fuzz_model.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expect_answer([&] { parse_npy(fuzz::bytes_of(data, size), "fuzz.npy"); });
  return 0;
}
