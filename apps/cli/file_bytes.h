#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "fovea/io/write.h"
#include "fovea/model/model.h"

namespace fovea::cli {

/// What a model takes on disk.
struct FileBytes {
  std::string format;       ///< "glb", "gltf", "obj", ...
  std::uint64_t files = 0;  ///< The file with its buffers and images beside it.
  ByteCounts kinds;         ///< Adds up to `files`.
};

/// Measures the file at `path`, from which `model` was read. glTF is measured exactly from its buffer
/// views, compressed sizes included; of any other format the images are known and the rest counts as
/// geometry. Throws Error(input) if the file cannot be read. O(size of the JSON part).
FileBytes measure_input(const std::filesystem::path& path, const Model& model);
/// The same for the files that `write_model` returned.
FileBytes measure_output(std::span<const std::filesystem::path> files, const Model& model);

nlohmann::ordered_json to_json(const FileBytes& bytes);

}  // namespace fovea::cli
