#include "fovea/io/off_read.h"

#include "fuzz/fuzz_model.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expect_answer([&] {
    Context context;
    fuzz::use(read_off(fuzz::bytes_of(data, size), "fuzz.off", fuzz::small_limits(), context));
  });
  return 0;
}
