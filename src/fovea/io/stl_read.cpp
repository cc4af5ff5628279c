#include "fovea/io/stl_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "fovea/base/error.h"
#include "fovea/io/indexed_mesh.h"
#include "fovea/io/text_scan.h"

namespace fovea {

namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;

std::uint32_t read_u32(const std::byte* at) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | std::to_integer<std::uint32_t>(at[i]);
  return value;
}
float read_f32(const std::byte* at) { return std::bit_cast<float>(read_u32(at)); }

bool is_binary_stl(std::span<const std::byte> bytes) {
  return bytes.size() >= kHeader &&
         bytes.size() == kHeader + std::uint64_t{kFacet} * read_u32(bytes.data() + 80);
}

bool is_text_stl(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                              std::min<std::size_t>(bytes.size(), 4096));
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text.substr(first).starts_with("solid") &&
         (text.find("facet") != text.npos || text.find("endsolid") != text.npos);
}

std::vector<Vec3f> read_binary(std::span<const std::byte> bytes, const std::string& place) {
  if (bytes.size() < kHeader) {
    throw Error(ErrorKind::format, fmt::format("{} bytes are too few for STL", bytes.size()), place);
  }
  const std::uint64_t count = read_u32(bytes.data() + 80);
  if (count > (bytes.size() - kHeader) / kFacet) {
    throw Error(ErrorKind::format,
                fmt::format("{} triangles need {} bytes but the file has {}", count, kHeader + kFacet * count,
                            bytes.size()),
                place + ": byte 80");
  }
  std::vector<Vec3f> corners;
  corners.reserve(3 * count);
  for (std::uint64_t t = 0; t < count; ++t) {
    const std::byte* facet = bytes.data() + kHeader + kFacet * t;
    for (int k = 1; k <= 3; ++k) {
      const std::byte* p = facet + 12 * k;
      const Vec3f q{read_f32(p), read_f32(p + 4), read_f32(p + 8)};
      if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z)) {
        throw Error(ErrorKind::format, fmt::format("triangle {} has a corner that is not a finite number", t),
                    fmt::format("{}: byte {}", place, p - bytes.data()));
      }
      corners.push_back(q);
    }
  }
  return corners;
}

std::vector<Vec3f> read_text(std::span<const std::byte> bytes, const std::string& place) {
  TextScanner scan(bytes);
  std::vector<Vec3f> corners;
  const auto refuse = [&](const char* message) {
    throw Error(ErrorKind::format, message, fmt::format("{}: line {}", place, scan.line()));
  };
  for (; !scan.at_end(); scan.next_line()) {
    const std::string_view word = scan.word();
    if (word == "vertex" || word == "VERTEX") {
      Vec3f p;
      if (!scan.number(p.x) || !scan.number(p.y) || !scan.number(p.z)) refuse("a vertex needs three numbers");
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) refuse("a vertex is not finite");
      corners.push_back(p);
    } else if (word == "endfacet" || word == "ENDFACET") {
      if (corners.size() % 3 != 0) refuse("a facet has not three corners");
    }
  }
  if (corners.size() % 3 != 0) refuse("the file ends inside a facet");
  return corners;
}

}  // namespace

bool is_stl(std::span<const std::byte> bytes) { return is_binary_stl(bytes) || is_text_stl(bytes); }

Model read_stl(std::span<const std::byte> bytes, const std::string& place, const ReadOptions& options,
               Context& context) {
  // Many binary files begin with "solid" too: the size decides first.
  const bool text = !is_binary_stl(bytes) && is_text_stl(bytes);
  IndexedMesh mesh;
  mesh.positions = text ? read_text(bytes, place) : read_binary(bytes, place);
  check_element_count(mesh.positions.size(), "vertices", options, place);
  IndexedMesh::Group& group = mesh.groups.emplace_back();
  group.positions.resize(mesh.positions.size());
  for (std::size_t i = 0; i < group.positions.size(); ++i) group.positions[i] = static_cast<std::uint32_t>(i);
  return model_of(weld(std::move(mesh), options, context, place),
                  std::filesystem::path(place).stem().string());
}

}  // namespace fovea
