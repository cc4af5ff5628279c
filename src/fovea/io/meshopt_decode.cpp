#include "fovea/io/meshopt_decode.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "fovea/io/format_error.h"
#include "fovea/io/gltf_json.h"
#include "fovea/io/meshopt_vertex_v1.h"

namespace fovea::gltf {

namespace {

bool is_version_1(const MeshoptStream& s) { return !s.bytes.empty() && s.bytes[0] == std::byte{0xA1}; }

/// Fewest bytes that can hold `count` elements: codes of triangles, indices or empty blocks, and the
/// fixed tail of each codec.
std::uint64_t smallest_stream(const MeshoptStream& s) {
  if (s.mode == "TRIANGLES") return 1 + s.count / 3 + 16;
  if (s.mode == "INDICES") return 1 + s.count + 4;
  const std::size_t block = vertex_block_size(s.stride);
  const std::uint64_t blocks = s.count / block + (s.count % block != 0);
  return 1 + blocks * (is_version_1(s) ? s.stride / 4 : s.stride) + s.stride;
}

void check_layout(const MeshoptStream& s) {
  if (s.mode == "ATTRIBUTES") {
    if (s.stride == 0 || s.stride % 4 != 0 || s.stride > 256) {
      fail(fmt::format("a stride of {} bytes is not a multiple of 4 up to 256", s.stride));
    }
  } else if (s.mode == "TRIANGLES" || s.mode == "INDICES") {
    if (s.stride != 2 && s.stride != 4) fail(fmt::format("indices of {} bytes", s.stride));
    if (s.mode == "TRIANGLES" && s.count % 3 != 0)
      fail(fmt::format("{} indices do not make triangles", s.count));
  } else {
    fail(shown(s.mode) + " is not a mode of meshopt compression");
  }
}

void check_filter(const MeshoptStream& s) {
  const bool wide_4 = s.stride == 4 || s.stride == 8;
  const bool fits = (s.filter == "OCTAHEDRAL" && wide_4) || (s.filter == "COLOR" && wide_4) ||
                    (s.filter == "QUATERNION" && s.stride == 8) || s.filter == "EXPONENTIAL";
  if (s.filter != "NONE" && (s.mode != "ATTRIBUTES" || !fits)) {
    fail(fmt::format("filter {} does not go with mode {} and a stride of {} bytes", shown(s.filter),
                     shown(s.mode), s.stride));
  }
}

/// YCoCg back to RGB; alpha carries the number of bits in its highest set bit
/// (KHR_meshopt_compression, appendix B, "Filter 4: color").
template <class Unsigned, class Signed>
void decode_color(std::byte* data, std::size_t count) {
  constexpr double kTop = static_cast<double>(static_cast<Unsigned>(~Unsigned{0}));
  for (std::size_t i = 0; i < count; ++i, data += 4 * sizeof(Unsigned)) {
    Unsigned raw[4];
    std::memcpy(raw, data, sizeof(raw));
    const int y = raw[0], co = static_cast<Signed>(raw[1]), cg = static_cast<Signed>(raw[2]);
    const int used = (1 << std::bit_width(static_cast<unsigned>(raw[3]))) - 1;
    const int alpha = raw[3] & (used >> 1);
    const int rgba[4] = {y + co - cg, y + cg, y - co - cg, alpha << 1 | (alpha & 1)};
    const double scale = used > 0 ? kTop / used : 0.0;
    for (int k = 0; k < 4; ++k) {
      raw[k] = static_cast<Unsigned>(static_cast<std::int64_t>(std::floor(rgba[k] * scale + 0.5)));
    }
    std::memcpy(data, raw, sizeof(raw));
  }
}

void apply_filter(const MeshoptStream& s, std::byte* data) {
  if (s.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data, s.count, s.stride);
  if (s.filter == "QUATERNION") meshopt_decodeFilterQuat(data, s.count, s.stride);
  if (s.filter == "EXPONENTIAL") meshopt_decodeFilterExp(data, s.count, s.stride);
  if (s.filter == "COLOR" && s.stride == 4) decode_color<std::uint8_t, std::int8_t>(data, s.count);
  if (s.filter == "COLOR" && s.stride == 8) decode_color<std::uint16_t, std::int16_t>(data, s.count);
}

bool decode_stream(const MeshoptStream& s, std::byte* out) {
  const auto* from = reinterpret_cast<const unsigned char*>(s.bytes.data());
  if (s.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(out, s.count, s.stride, from, s.bytes.size()) == 0;
  if (s.mode == "INDICES")
    return meshopt_decodeIndexSequence(out, s.count, s.stride, from, s.bytes.size()) == 0;
  if (is_version_1(s)) return decode_vertices_v1(s.bytes, s.count, s.stride, out);
  return meshopt_decodeVertexBuffer(out, s.count, s.stride, from, s.bytes.size()) == 0;
}

}  // namespace

void check_meshopt(const MeshoptStream& stream) {
  check_layout(stream);
  check_filter(stream);
  if (stream.bytes.size() < smallest_stream(stream)) {
    fail(fmt::format("{} bytes of compressed data cannot hold {} elements", stream.bytes.size(),
                     stream.count));
  }
}

std::vector<std::byte> decode_meshopt(const MeshoptStream& stream) {
  std::vector<std::byte> out(stream.count * stream.stride);
  if (stream.count == 0) return out;
  if (!decode_stream(stream, out.data())) fail("the meshopt compressed data is damaged");
  apply_filter(stream, out.data());
  return out;
}

}  // namespace fovea::gltf
