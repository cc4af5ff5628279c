#include "fovea/lod/level_chunk.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>

#include "fovea/io/read.h"

namespace fovea {

namespace {

constexpr std::uint16_t kVersion = 1;
constexpr int kEffort = 9;
/// Deflate makes nothing smaller than by this factor (RFC 1951: 258 bytes by two bits at best).
constexpr std::uint64_t kMostExpansion = 1040;

const Bytef* pointer(std::span<const std::byte> bytes) {
  return reinterpret_cast<const Bytef*>(bytes.data());
}

std::span<const std::byte> magic() { return std::as_bytes(std::span(kLevelsMagic)); }

/// 0 stands for none.
std::uint32_t checksum(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, pointer(bytes), bytes.size()));
}

}  // namespace

void write_head(ByteWriter& out) {
  out.append(magic());
  out.number(kVersion);
}

bool has_levels_magic(std::span<const std::byte> bytes) {
  return bytes.size() >= magic().size() && std::ranges::equal(bytes.first(magic().size()), magic());
}

void read_head(ByteReader& in) {
  if (in.left() < magic().size() || !has_levels_magic(in.take(magic().size())))
    throw Error(ErrorKind::format, "this is no file of levels", {}, "\"fovea lods\" makes them");
  const auto version = in.number<std::uint16_t>();
  if (version != kVersion)
    throw Error(ErrorKind::unsupported,
                fmt::format("the levels are of version {}, known is {}", version, kVersion), {},
                "make them again, or take a newer Fovea");
}

void write_chunk(ByteWriter& out, ChunkType type, std::span<const std::byte> content) {
  if (content.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::limit, "a part of the levels is larger than 4 GiB");
  out.number(static_cast<std::uint32_t>(type));
  out.number(static_cast<std::uint32_t>(content.size()));
  out.number(checksum(content));
  out.append(content);
}

std::optional<Chunk> read_chunk(ByteReader& in) {
  constexpr std::size_t kHead = 12;
  if (in.left() < kHead) return std::nullopt;
  Chunk chunk;
  chunk.type = static_cast<ChunkType>(in.number<std::uint32_t>());
  const auto size = in.number<std::uint32_t>();
  const auto sum = in.number<std::uint32_t>();
  if (size > in.left()) return std::nullopt;
  chunk.content = in.take(size);
  if (sum != 0 && sum != checksum(chunk.content)) damaged_levels("a checksum is wrong");
  return chunk;
}

Bytes pack(std::span<const Bytes> streams) {
  ByteWriter out;
  Bytes packed;
  for (const Bytes& stream : streams) {
    packed.resize(compressBound(static_cast<uLong>(stream.size())));
    auto size = static_cast<uLongf>(packed.size());
    compress2(reinterpret_cast<Bytef*>(packed.data()), &size, pointer(stream),
              static_cast<uLong>(stream.size()), kEffort);
    out.varint(stream.size());
    if (size < stream.size()) {
      out.varint(size);
      out.append(std::span(packed).first(size));
    } else {
      out.varint(stream.size());
      out.append(stream);
    }
  }
  return std::move(out.bytes);
}

std::vector<Bytes> unpack(std::span<const std::byte> packed, std::size_t count, std::uint64_t& budget) {
  ByteReader in(packed);
  std::vector<Bytes> streams(count);
  for (Bytes& stream : streams) {
    const std::uint64_t size = in.varint();
    const std::span<const std::byte> from = in.take(in.count(in.left()));
    if (size > budget) throw Error(ErrorKind::limit, "the levels take more memory than is allowed");
    budget -= size;
    if (size == from.size()) {
      stream.assign(from.begin(), from.end());
      continue;
    }
    if (size < from.size() || size > kMostExpansion * from.size())
      damaged_levels("a stream has no such size");
    stream.resize(size);
    auto found = static_cast<uLongf>(size);
    if (uncompress(reinterpret_cast<Bytef*>(stream.data()), &found, pointer(from),
                   static_cast<uLong>(from.size())) != Z_OK ||
        found != size)
      damaged_levels("a stream cannot be unpacked");
  }
  if (in.left() > 0) damaged_levels("something follows the last stream");
  return streams;
}

}  // namespace fovea
