// Reads arbitrary bytes as glTF and simplifies what comes of it, whatever its numbers are; what is written of
// that must be read again.

#include "fovea/io/gltf_read.h"
#include "fovea/io/gltf_write.h"
#include "fovea/lod/levels_file.h"
#include "fovea/simplify/simplify.h"
#include "fuzz/fuzz_model.h"
#include "fuzz/gltf_mutator.h"

using namespace fovea;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  return fuzz::mutate_gltf(data, size, max_size, seed);
}

namespace {

Model read(std::span<const std::byte> bytes, Context& context) {
  return read_gltf(bytes, "/nonexistent", "fuzz.glb", fuzz::small_limits(), context);
}

/// How a file is simplified and written follows from its size, so that all ways are gone.
SimplifyOptions options_for(std::size_t size) {
  SimplifyOptions options;
  options.metric = size % 4 == 0 ? Metric::image : Metric::quadric;
  options.view_size = 16;
  options.views.set = ViewSet::tetrahedron;
  options.ratio = 0.1 * static_cast<double>(size % 8);
  options.placement = size % 3 == 0 ? Placement::half_edge : Placement::optimal;
  return options;
}

WriteOptions ways_for(std::size_t size) {
  WriteOptions options;
  options.quantize = size % 2 == 0;
  if (size % 5 == 0) options.compression = GeometryCompression::meshopt;
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::expect_answer([&] {
    Context context;
    context.threads = 1;
    const Model model = read(fuzz::bytes_of(data, size), context);
    // A few kilobytes can stand for a million triangles, which are no better than a thousand.
    if (counts(model).triangles > 2000) return;
    levels_inside(model, {}, fuzz::small_limits(), context);
    const SimplifyResult result = simplify(model, options_for(size), {}, context);
    for (const Mesh& mesh : result.model.meshes) check(mesh.surface);
    const GltfOutput written = write_gltf(result.model, true, "out", ways_for(size), context);
    const Model again = read(written.files.front().bytes, context);
    for (const Mesh& mesh : again.meshes) check(mesh.surface);
  });
  return 0;
}
