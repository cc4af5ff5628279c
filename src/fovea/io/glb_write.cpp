#include "fovea/io/glb_write.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "fovea/base/error.h"

namespace fovea {

namespace {

void append(std::vector<std::byte>& out, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFF));
}

}  // namespace

std::vector<std::byte> make_glb(std::string json, const std::vector<std::byte>& binary) {
  constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBin = 0x004E4942;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size());
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorKind::limit, fmt::format("{} bytes do not fit a GLB file, which ends at 4 GiB", total),
                {}, "write .gltf instead");
  }
  std::vector<std::byte> out;
  out.reserve(total);
  for (const std::uint32_t word : {kMagic, std::uint32_t{2}, static_cast<std::uint32_t>(total),
                                   static_cast<std::uint32_t>(json.size()), kJson}) {
    append(out, word);
  }
  const std::byte* text = reinterpret_cast<const std::byte*>(json.data());
  out.insert(out.end(), text, text + json.size());
  if (binary.empty()) return out;
  append(out, static_cast<std::uint32_t>(binary.size()));
  append(out, kBin);
  out.insert(out.end(), binary.begin(), binary.end());
  return out;
}

}  // namespace fovea
