#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

// Private to io.

namespace fovea::gltf {

/// The parts of a GLB container, as views of the file.
struct GlbChunks {
  std::span<const std::byte> json;
  std::size_t json_offset = 0;                       ///< Where `json` begins in the file.
  std::optional<std::span<const std::byte>> binary;  ///< The BIN chunk, if there is one.
};

/// Whether `bytes` begin with GLB's magic number.
bool is_glb(std::span<const std::byte> bytes);

/// Takes a GLB file apart. Throws Error(format) with the byte offset for a file that is cut short or
/// whose lengths contradict each other, Error(unsupported) for another version than 2.
GlbChunks split_glb(std::span<const std::byte> bytes, const std::string& place);

}  // namespace fovea::gltf
