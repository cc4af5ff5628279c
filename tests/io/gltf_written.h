#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fovea/io/gltf_read.h"
#include "fovea/io/gltf_write.h"

namespace fovea::test {

/// A model written as GLB, in its parts and read again.
struct Written {
  std::vector<std::byte> file;
  ByteCounts counts;
  nlohmann::json json;
  std::vector<std::byte> binary;
  Context context;  ///< Of writing.

  explicit Written(const Model& model, const WriteOptions& options = {}, int threads = 1) {
    context.threads = threads;
    GltfOutput output = write_gltf(model, true, "model", options, context);
    file = std::move(output.files.at(0).bytes);
    counts = output.bytes;
    const std::size_t json_size = word(12);
    json = nlohmann::json::parse(text(20, json_size));
    if (file.size() > 28 + json_size)
      binary.assign(file.begin() + 28 + static_cast<long>(json_size), file.end());
  }

  std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, sizeof(value));
    return value;
  }
  std::string text(std::size_t at, std::size_t size) const {
    return {reinterpret_cast<const char*>(file.data()) + at, size};
  }
  Model read() const {
    Context quiet;
    return read_gltf(file, ".", "written.glb", ReadOptions{}, quiet);
  }
  std::uint64_t told(const std::string& code) const {
    for (const Diagnostic& d : context.diagnostics()) {
      if (d.code == code) return d.count;
    }
    return 0;
  }
  const nlohmann::json& primitive(std::size_t mesh = 0, std::size_t part = 0) const {
    return json.at("meshes").at(mesh).at("primitives").at(part);
  }
  const nlohmann::json& accessor(const nlohmann::json& index) const {
    return json.at("accessors").at(index.get<std::size_t>());
  }
  const nlohmann::json& view_of(const nlohmann::json& accessor_json) const {
    return json.at("bufferViews").at(accessor_json.at("bufferView").get<std::size_t>());
  }
  /// The numbers of an accessor as stored, not as meant.
  template <class T>
  std::vector<T> raw(const nlohmann::json& index) const {
    const nlohmann::json &a = accessor(index), &view = view_of(a);
    static const std::map<std::string, std::size_t> kWidths = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    const std::size_t width = kWidths.at(a.at("type")), count = a.at("count");
    const std::size_t stride = view.value("byteStride", width * sizeof(T));
    const std::size_t begin =
        view.at("byteOffset").get<std::size_t>() + a.value("byteOffset", std::size_t{0});
    std::vector<T> values(width * count);
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(&values[i * width], binary.data() + begin + i * stride, width * sizeof(T));
    }
    return values;
  }
};

inline bool lists(const nlohmann::json& root, const char* list, const std::string& extension) {
  const auto names = root.value(list, nlohmann::json::array());
  return std::find(names.begin(), names.end(), extension) != names.end();
}

}  // namespace fovea::test
