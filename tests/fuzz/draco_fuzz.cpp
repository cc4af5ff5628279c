#include "fovea/io/draco_decode.h"

#include <array>

#include "fuzz/fuzz_model.h"

using namespace fovea;

// The first byte chooses how many attributes are asked for, the rest is the stream.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::size_t kMost = 1 << 16;
  constexpr std::array<int, 4> kWidths{3, 2, 3, 4};
  std::vector<gltf::DracoAttribute> attributes;
  for (std::uint32_t id = 0; id <= data[0] % kWidths.size(); ++id)
    attributes.push_back({id, {{ComponentType::f32, false}, kWidths[id], false, kMost}});
  fuzz::expect_answer([&] {
    const gltf::DracoMesh mesh = gltf::decode_draco(fuzz::bytes_of(data + 1, size - 1), attributes, kMost);
    // Indices are checked where parts become a mesh, whatever they came from.
    if (mesh.indices.size() % 3 != 0) std::abort();
    for (const Accessor& attribute : mesh.attributes) {
      if (attribute.count != mesh.vertex_count) std::abort();
    }
  });
  return 0;
}
