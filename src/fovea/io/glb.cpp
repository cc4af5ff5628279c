#include "fovea/io/glb.h"

#include <fmt/format.h>

#include <cstdint>

#include "fovea/base/error.h"

namespace fovea::gltf {

namespace {

constexpr std::uint32_t kMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
  return word;
}

[[noreturn]] void fail_at(const std::string& message, const std::string& place, std::size_t offset,
                          ErrorKind kind = ErrorKind::format) {
  throw Error(kind, message, fmt::format("{}: byte {}", place, offset));
}

/// The file as far as its header says that it goes.
std::span<const std::byte> checked_extent(std::span<const std::byte> bytes, const std::string& place) {
  if (bytes.size() < kHeaderBytes) fail_at("the file ends inside the GLB header", place, bytes.size());
  const std::uint32_t version = word_at(bytes, 4);
  if (version != 2)
    fail_at(fmt::format("GLB version {} is not 2", version), place, 4, ErrorKind::unsupported);
  const std::uint32_t length = word_at(bytes, 8);
  if (length > bytes.size()) {
    fail_at(fmt::format("the header says {} bytes but the file has {}", length, bytes.size()), place, 8);
  }
  if (length < kHeaderBytes)
    fail_at(fmt::format("length {} is less than the header itself", length), place, 8);
  return bytes.first(length);
}

}  // namespace

bool is_glb(std::span<const std::byte> bytes) { return bytes.size() >= 4 && word_at(bytes, 0) == kMagic; }

GlbChunks split_glb(std::span<const std::byte> bytes, const std::string& place) {
  const auto file = checked_extent(bytes, place);
  GlbChunks chunks;
  bool has_json = false;
  for (std::size_t offset = kHeaderBytes; offset < file.size();) {
    // Some writers pad the end of the file with less than a chunk's header.
    if (file.size() - offset < kChunkHeaderBytes && has_json) break;
    if (file.size() - offset < kChunkHeaderBytes)
      fail_at("the file ends inside a chunk header", place, offset);
    const std::size_t length = word_at(file, offset);
    const std::uint32_t type = word_at(file, offset + 4);
    const std::size_t begin = offset + kChunkHeaderBytes;
    if (length > file.size() - begin) {
      fail_at(
          fmt::format("a chunk of {} bytes does not fit the {} that are left", length, file.size() - begin),
          place, offset);
    }
    if (!has_json && type != kJsonChunk) fail_at("the first chunk is not JSON", place, offset + 4);
    if (!has_json) {
      chunks.json = file.subspan(begin, length);
      chunks.json_offset = begin;
      has_json = true;
    } else if (type == kBinaryChunk && !chunks.binary) {
      chunks.binary = file.subspan(begin, length);
    }
    offset = begin + length;
  }
  if (!has_json) fail_at("there is no JSON chunk", place, kHeaderBytes);
  return chunks;
}

}  // namespace fovea::gltf
