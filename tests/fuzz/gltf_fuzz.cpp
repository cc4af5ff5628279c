// Reads arbitrary bytes as glTF. What is read must keep the promises of the model; what is refused must be
// refused for a reason that lies in the file.

#include "fovea/io/gltf_read.h"
#include "fuzz/fuzz_model.h"
#include "fuzz/gltf_mutator.h"

using namespace fovea;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  return fuzz::mutate_gltf(data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expect_answer([&] {
    Context context;
    context.threads = 1;
    // The folder does not exist: a fuzzer has no business with files.
    fuzz::use(
        read_gltf(fuzz::bytes_of(data, size), "/nonexistent", "fuzz.glb", fuzz::small_limits(), context));
  });
  return 0;
}
