#include "fovea/lod/levels_file.h"

#include "fuzz/fuzz_model.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expect_answer([&] {
    Context context;
    fuzz::use(
        read_levels(fuzz::bytes_of(data, size), "fuzz.fovea", {}, fuzz::small_limits(), context).original);
  });
  return 0;
}
