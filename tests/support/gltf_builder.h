#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace fovea::test {

/// Makes small glTF files in memory. `json` is the root object: tests edit it as they like, also into
/// nonsense. Data goes into buffer 0, which becomes the BIN chunk of a GLB or a data URI.
class GltfBuilder {
 public:
  using Json = nlohmann::ordered_json;

  GltfBuilder();

  Json json;
  std::vector<std::byte> binary;

  /// Index of a new buffer view with these bytes, at a multiple of 4.
  int add_view(std::span<const std::byte> bytes);
  /// Index of a new accessor over a view of its own. `type` is "VEC3", ...; the component type is T's.
  template <class T>
  int add_accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const int view = add_view(std::as_bytes(std::span(values)));
    return add_accessor_json(view, values.size() / width_of(type), component_type<T>(), type, normalized);
  }
  int add_accessor_json(int view, std::size_t count, int component_type, const std::string& type,
                        bool normalized);

  /// Adds a mesh with this one primitive, and a node that shows it. Returns the mesh's index.
  int add_mesh(Json primitive);
  /// One triangle (0 0 0), (1 0 0), (0 1 0) with indices: accessors 0 (positions) and 1 (indices), mesh 0,
  /// node 0, scene 0.
  static GltfBuilder triangle();

  std::vector<std::byte> glb() const;
  /// The .gltf file with the data as a data URI.
  std::vector<std::byte> gltf() const;

  static std::vector<std::byte> glb(const std::string& json, const std::vector<std::byte>& binary);
  static std::string base64(std::span<const std::byte> bytes);

 private:
  static std::size_t width_of(const std::string& type);
  template <class T>
  static constexpr int component_type() {
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
  }
};

/// Text as bytes.
std::vector<std::byte> to_bytes(const std::string& text);
/// Bytes of a string of hexadecimal digits.
std::vector<std::byte> from_hex(const std::string& digits);

}  // namespace fovea::test
