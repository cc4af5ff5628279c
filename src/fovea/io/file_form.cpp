#include "fovea/io/file_form.h"

#include "fovea/base/text.h"
#include "fovea/io/gltf_write.h"

namespace fovea {

FileForm file_form(const std::filesystem::path& path, const WriteOptions& options) {
  return {options, lower_extension(path) == ".glb", path.stem().string()};
}

WrittenBytes written_bytes(const Model& model, const FileForm& form, Context& context) {
  const GltfOutput output = write_gltf(model, form.binary, form.stem, form.write, context);
  std::uint64_t total = 0;
  for (const OutputFile& file : output.files) total += file.bytes.size();
  return {output.bytes.images, total - output.bytes.images};
}

}  // namespace fovea
