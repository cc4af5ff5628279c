#pragma once

#include <cstddef>
#include <span>

// Private to io.

namespace fovea::gltf {

/// Decodes vertices in version 1 of meshoptimizer's vertex codec, which the library of Debian 12 does
/// not know (KHR_meshopt_compression, appendix A, "Mode 0: attributes"). `out` has room for `count` ×
/// `stride` bytes; `stride` is a multiple of 4 up to 256. Returns false for a damaged stream.
bool decode_vertices_v1(std::span<const std::byte> stream, std::size_t count, std::size_t stride,
                        std::byte* out);

/// The most elements that one block of the codec holds; the same in all versions.
std::size_t vertex_block_size(std::size_t stride);

}  // namespace fovea::gltf
