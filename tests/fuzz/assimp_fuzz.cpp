#include "fovea/io/assimp_read.h"

#include <array>

#include "fuzz/fuzz_model.h"

using namespace fovea;

// The first byte chooses the format, the rest is the file. The import library itself runs in a process
// of its own: what is tested is that whatever happens there is an answer here.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<const char*, 7> kNames = {"f.fbx", "f.dae", "f.3ds", "f.x", "f.lwo", "f.ac", "f.3mf"};
  if (size == 0) return 0;
  const std::string path = std::string("/nonexistent/") + kNames[data[0] % kNames.size()];
  fuzz::expect_answer([&] {
    Context context;
    fuzz::use(read_assimp(fuzz::bytes_of(data + 1, size - 1), path, fuzz::small_limits(), context));
  });
  return 0;
}
