#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fovea/lod/level_bytes.h"

// Private to lod. docs/levels.md describes the bytes.

namespace fovea {

enum class ChunkType : std::uint32_t {  // four letters, the first lowest
  scene = 0x4E454353,                   // SCEN
  base = 0x45534142,                    // BASE
  more = 0x45524F4D,                    // MORE
  done = 0x454E4F44,                    // DONE
};

/// What files of levels begin with.
void write_head(ByteWriter& out);
bool has_levels_magic(std::span<const std::byte> bytes);
/// Throws Error(format) for another file, Error(unsupported) for another version.
void read_head(ByteReader& in);

/// Type, size, checksum and content.
void write_chunk(ByteWriter& out, ChunkType type, std::span<const std::byte> content);

struct Chunk {
  ChunkType type{};
  std::span<const std::byte> content;
};
/// The next chunk; none if the bytes end before it does. Throws Error(format) for a wrong checksum.
std::optional<Chunk> read_chunk(ByteReader& in);

/// A content of several streams, each compressed by itself.
Bytes pack(std::span<const Bytes> streams);
/// Throws Error(format) unless there are so many streams and nothing else, Error(limit) if they take more
/// than `budget`, from which they are taken.
std::vector<Bytes> unpack(std::span<const std::byte> packed, std::size_t count, std::uint64_t& budget);

}  // namespace fovea
