#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "fovea/base/context.h"
#include "fovea/io/write.h"
#include "fovea/model/model.h"

namespace fovea {

/// How a file will be written: all that its bytes depend on beside the model.
struct FileForm {
  WriteOptions write;
  bool binary = true;          ///< GLB, or glTF with files beside it,
  std::string stem = "model";  ///< named after this: names take bytes too.
};

/// That of a .glb or .gltf at `path`.
FileForm file_form(const std::filesystem::path& path, const WriteOptions& options);

/// Bytes of all files together, images apart.
struct WrittenBytes {
  std::uint64_t images = 0, rest = 0;
  std::uint64_t total() const { return images + rest; }
};

/// What writing a model would take: it is encoded. Diagnostics go to `context`. Throws as `write_gltf`.
WrittenBytes written_bytes(const Model& model, const FileForm& form, Context& context);

}  // namespace fovea
