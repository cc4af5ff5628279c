#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/model/model.h"

namespace fovea {

/// What a model takes on disk, and for what.
struct FileBytes {
  FileFormat format = FileFormat::other;
  std::uint64_t files = 0;  ///< The file with its buffers, images and materials beside it.
  ByteCounts kinds;         ///< Adds up to `files`.
};

/// Measures the file at `path`, from which `model` was read. glTF is measured exactly from its buffer
/// views, compressed sizes included; a view with several uses counts as geometry before images before
/// animation. Of any other format the images are known and the rest counts as geometry.
///
/// Throws Error(input) if the file cannot be read. O(size of the JSON part).
FileBytes measure_input(const std::filesystem::path& path, const Model& model);

/// The same for the files that `write_model` returned, at least one.
FileBytes measure_output(std::span<const std::filesystem::path> files, const Model& model);

}  // namespace fovea
