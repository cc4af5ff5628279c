#include "fovea/io/mtl_read.h"

#include "fuzz/fuzz_model.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expect_answer([&] {
    Context context;
    Model model;
    const ReadOptions options = fuzz::small_limits();
    TextureLoader textures(model, "/nonexistent", options, context);
    read_mtl(fuzz::bytes_of(data, size), "fuzz.mtl", {"a", "b"}, textures, context);
  });
  return 0;
}
