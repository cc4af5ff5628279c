#include "support/gltf_builder.h"

#include <algorithm>

namespace fovea::test {

namespace {

void append_word(std::vector<std::byte>& out, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(word >> (8 * i)));
}

void append_chunk(std::vector<std::byte>& out, std::uint32_t type, std::vector<std::byte> content,
                  std::byte padding) {
  while (content.size() % 4 != 0) content.push_back(padding);
  append_word(out, static_cast<std::uint32_t>(content.size()));
  append_word(out, type);
  out.insert(out.end(), content.begin(), content.end());
}

}  // namespace

GltfBuilder::GltfBuilder() { json["asset"] = {{"version", "2.0"}}; }

int GltfBuilder::add_view(std::span<const std::byte> bytes) {
  while (binary.size() % 4 != 0) binary.push_back(std::byte{0});
  Json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  binary.insert(binary.end(), bytes.begin(), bytes.end());
  json["bufferViews"].push_back(std::move(view));
  json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
  return static_cast<int>(json["bufferViews"].size()) - 1;
}

int GltfBuilder::add_accessor_json(int view, std::size_t count, int component_type, const std::string& type,
                                   bool normalized) {
  Json accessor = {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}};
  if (normalized) accessor["normalized"] = true;
  json["accessors"].push_back(std::move(accessor));
  return static_cast<int>(json["accessors"].size()) - 1;
}

int GltfBuilder::add_mesh(Json primitive) {
  json["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
  const int mesh = static_cast<int>(json["meshes"].size()) - 1;
  json["nodes"].push_back({{"mesh", mesh}});
  json["scene"] = 0;
  json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
  return mesh;
}

GltfBuilder GltfBuilder::triangle() {
  GltfBuilder builder;
  const int positions = builder.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int indices = builder.add_accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  return builder;
}

std::vector<std::byte> GltfBuilder::glb() const { return glb(json.dump(), binary); }

std::vector<std::byte> GltfBuilder::gltf() const {
  Json with_data = json;
  if (!binary.empty())
    with_data["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(binary);
  return to_bytes(with_data.dump());
}

std::vector<std::byte> GltfBuilder::glb(const std::string& json, const std::vector<std::byte>& binary) {
  std::vector<std::byte> chunks;
  append_chunk(chunks, 0x4E4F534A, to_bytes(json), std::byte{' '});
  if (!binary.empty()) append_chunk(chunks, 0x004E4942, binary, std::byte{0});
  std::vector<std::byte> file;
  append_word(file, 0x46546C67);
  append_word(file, 2);
  append_word(file, static_cast<std::uint32_t>(12 + chunks.size()));
  file.insert(file.end(), chunks.begin(), chunks.end());
  return file;
}

std::string GltfBuilder::base64(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::size_t GltfBuilder::width_of(const std::string& type) {
  static const std::vector<std::pair<std::string, std::size_t>> kWidths = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  const auto known =
      std::find_if(kWidths.begin(), kWidths.end(), [&](const auto& w) { return w.first == type; });
  return known->second;
}

std::vector<std::byte> to_bytes(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> from_hex(const std::string& digits) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

}  // namespace fovea::test
