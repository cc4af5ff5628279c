#include "fovea/io/meshopt_decode.h"

#include <array>

#include "fuzz/fuzz_model.h"

using namespace fovea;

// Four bytes choose mode, filter, stride and count, the rest is the stream.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHead = 4;
  if (size < kHead) return 0;
  constexpr std::array<const char*, 3> kModes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr std::array<const char*, 5> kFilters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
  gltf::MeshoptStream stream;
  stream.mode = kModes[data[0] % kModes.size()];
  stream.filter = kFilters[data[1] % kFilters.size()];
  stream.stride = data[2];
  stream.count = data[3];
  stream.bytes = fuzz::bytes_of(data + kHead, size - kHead);
  fuzz::expect_answer([&] {
    gltf::check_meshopt(stream);
    if (gltf::decode_meshopt(stream).size() != stream.count * stream.stride) std::abort();
  });
  return 0;
}
