#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/io/byte_budget.h"
#include "fovea/io/glb.h"
#include "fovea/io/gltf_json.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size)
    __attribute__((weak));

/// Changes glTF files so that they stay glTF files, for targets that read them.
namespace fovea::fuzz {

using gltf::Json;

// Bytes changed at random hardly ever leave JSON that can be parsed, so the mutator below changes values of
// the tree and makes a container with right lengths of it.

struct File {
  Json json;
  std::vector<std::byte> binary;
  bool is_glb = false;
};

inline bool take_apart(std::span<const std::byte> bytes, File& file) {
  try {
    gltf::GlbChunks chunks{bytes, 0, std::nullopt};
    file.is_glb = gltf::is_glb(bytes);
    if (file.is_glb) chunks = gltf::split_glb(bytes, "");
    ByteBudget budget(1 << 24);
    file.json = gltf::parse_json(chunks.json, "", 0, budget);
    if (chunks.binary) file.binary.assign(chunks.binary->begin(), chunks.binary->end());
    return true;
  } catch (const Error&) {
    return false;
  }
}

inline void append_chunk(std::vector<std::byte>& out, std::uint32_t type, const void* data,
                         std::uint32_t size) {
  const std::uint32_t head[2] = {size, type};
  const auto* begin = static_cast<const std::byte*>(data);
  out.insert(out.end(), reinterpret_cast<const std::byte*>(head),
             reinterpret_cast<const std::byte*>(head + 2));
  out.insert(out.end(), begin, begin + size);
}

inline std::vector<std::byte> put_together(const File& file) {
  const std::string text = file.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  if (!file.is_glb) return {begin, begin + text.size()};
  std::vector<std::byte> out(12);
  append_chunk(out, 0x4E4F534A, text.data(), static_cast<std::uint32_t>(text.size()));
  append_chunk(out, 0x004E4942, file.binary.data(), static_cast<std::uint32_t>(file.binary.size()));
  const std::uint32_t head[3] = {0x46546C67, 2, static_cast<std::uint32_t>(out.size())};
  std::memcpy(out.data(), head, sizeof(head));
  return out;
}

inline void collect(Json& value, std::vector<Json*>& all) {
  all.push_back(&value);
  if (value.is_structured()) {
    for (auto& member : value) collect(member, all);
  }
}

inline Json interesting(Random& random) {
  static const Json kValues[] = {
      0,       1,    2,   3,      4,      -1,         5120,        5121,          5123,
      5125,    5126, 255, 65536,  1e9,    4294967295, 1e15,        0.5,           1e300,
      nullptr, true, "",  "VEC3", "MAT4", "SCALAR",   "data:,abc", Json::array(), Json::object()};
  return kValues[random.below(std::size(kValues))];
}

inline void change_tree(File& file, Random& random) {
  std::vector<Json*> all;
  collect(file.json, all);
  Json& target = *all[random.below(static_cast<std::uint32_t>(all.size()))];
  const Json other = *all[random.below(static_cast<std::uint32_t>(all.size()))];
  switch (random.below(6)) {
    case 0: target = interesting(random); break;
    case 1: target = other; break;
    case 2:
      if (target.is_array()) target.push_back(other);
      if (target.is_object()) target["extensions"] = other;
      break;
    case 3:
      if (!target.empty() && target.is_array())
        target.erase(random.below(static_cast<std::uint32_t>(target.size())));
      if (!target.empty() && target.is_object()) target.erase(target.begin());
      break;
    default:
      if (target.is_number()) target = static_cast<std::int64_t>(random.below(40)) - 2;
      break;
  }
}

inline void change_binary(File& file, Random& random) {
  if (file.binary.empty()) return;
  for (std::uint32_t i = random.below(8); i < 8; ++i) {
    file.binary[random.below(static_cast<std::uint32_t>(file.binary.size()))] =
        static_cast<std::byte>(random.next());
  }
}

/// What LLVMFuzzerCustomMutator does.
inline std::size_t mutate_gltf(std::uint8_t* data, std::size_t size, std::size_t max_size,
                               unsigned int seed) {
  Random random(seed);
  File file;
  const bool whole = take_apart(std::as_bytes(std::span(data, size)), file);
  if (!whole || random.below(10) == 0)
    return LLVMFuzzerMutate ? LLVMFuzzerMutate(data, size, max_size) : size;
  for (std::uint32_t i = random.below(3); i < 3; ++i) {
    random.below(3) == 0 ? change_binary(file, random) : change_tree(file, random);
  }
  const std::vector<std::byte> out = put_together(file);
  if (out.size() > max_size) return size;
  std::memcpy(data, out.data(), out.size());
  return out.size();
}

}  // namespace fovea::fuzz
