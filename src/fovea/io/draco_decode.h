#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/io/gltf_accessor_read.h"

// Private to io.

namespace fovea::gltf {

/// An attribute that a Draco stream should hold, and the accessor that says how glTF sees it.
struct DracoAttribute {
  std::uint32_t id = 0;  ///< Unique id inside the stream.
  AccessorShape shape;   ///< The count is the most vertices that are accepted.
};

/// What a Draco stream holds.
struct DracoMesh {
  std::size_t vertex_count = 0;
  std::vector<std::uint32_t> indices;  ///< [#triangles × 3]
  std::vector<Accessor> attributes;    ///< One per request, [#vertices].
};

/// Decodes a triangle mesh. Throws without a place: Error(format) for damaged data, a missing attribute,
/// or more than `max_triangles` triangles or the requested counts of vertices (looked up in the stream's
/// header before anything is decoded), Error(unsupported) for another bitstream than glTF's 2.2.
DracoMesh decode_draco(std::span<const std::byte> stream, std::span<const DracoAttribute> attributes,
                       std::size_t max_triangles);

}  // namespace fovea::gltf
