#include "fovea/io/field_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include "fuzz/fuzz_model.h"

using namespace fovea;

// Numbers as text or .npy, from a file in memory.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("fuzz", 0);
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  fuzz::expect_answer([&] { read_field("/proc/self/fd/" + std::to_string(file)); });
  return 0;
}
