#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

// Private to io.

namespace fovea::gltf {

/// A compressed buffer view as EXT_meshopt_compression and KHR_meshopt_compression describe it.
struct MeshoptStream {
  std::span<const std::byte> bytes;
  std::size_t count = 0;   ///< Elements, or indices.
  std::size_t stride = 0;  ///< Bytes of one.
  std::string mode;        ///< "ATTRIBUTES", "TRIANGLES", "INDICES"
  std::string filter;      ///< "NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"
};

/// Throws Error(format) without a place if count, stride, mode and filter do not go together, or if the
/// bytes are too few to hold `count` elements: before anything is allocated.
void check_meshopt(const MeshoptStream& stream);

/// The `count` × `stride` bytes that the stream holds. Throws Error(format) without a place for damaged
/// data. The stream must have passed `check_meshopt`.
std::vector<std::byte> decode_meshopt(const MeshoptStream& stream);

}  // namespace fovea::gltf
