#include "fovea/io/file_bytes.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "fovea/base/error.h"

namespace fovea {

namespace fs = std::filesystem;
using Plain = nlohmann::json;

namespace {

// Enough to tell formats apart by their content.
constexpr std::uint64_t kHead = 8192;

// In order of precedence: a buffer view with several uses counts for the last of them here.
enum class Kind { other, animation, images, geometry };

const Plain kNothing;

const Plain& member(const Plain& json, const char* name) {
  if (!json.is_object()) return kNothing;
  const auto at = json.find(name);
  return at == json.end() ? kNothing : *at;
}

const Plain& list(const Plain& json, const char* name) {
  const Plain& found = member(json, name);
  return found.is_array() ? found : kNothing;
}

std::uint64_t number(const Plain& json) { return json.is_number_unsigned() ? json.get<std::uint64_t>() : 0; }

bool is_external(const Plain& element) {
  const Plain& uri = member(element, "uri");
  return uri.is_string() && uri.get_ref<const std::string&>().rfind("data:", 0) != 0;
}

/// Sorts the bytes of a glTF file by what they are for.
class GltfMeter {
 public:
  explicit GltfMeter(const Plain& root) : root_(root), kinds_(list(root, "bufferViews").size(), Kind::other) {
    mark_meshes();
    mark_images();
    mark_animation();
  }

  ByteCounts bytes() const {
    std::array<std::uint64_t, 4> sums{};
    for (std::size_t i = 0; i < kinds_.size(); ++i)
      sums[static_cast<std::size_t>(kinds_[i])] += view_bytes(i);
    ByteCounts counts;
    counts.animation = sums[1];
    counts.images = sums[2];
    counts.geometry = sums[3];
    for (const Plain& image : list(root_, "images")) {
      const Plain& uri = member(image, "uri");
      if (uri.is_string() && !is_external(image)) counts.images += uri.get_ref<const std::string&>().size();
    }
    return counts;
  }

  std::uint64_t external_buffer_bytes() const {
    std::uint64_t sum = 0;
    for (const Plain& buffer : list(root_, "buffers")) {
      if (is_external(buffer)) sum += number(member(buffer, "byteLength"));
    }
    return sum;
  }

  bool image_is_external(std::size_t index) const {
    const Plain& images = list(root_, "images");
    return index < images.size() && is_external(images[index]);
  }

 private:
  void mark_view(const Plain& index, Kind kind) {
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= kinds_.size()) return;
    Kind& at = kinds_[index.get<std::size_t>()];
    at = std::max(at, kind);
  }

  void mark_accessor(const Plain& index, Kind kind) {
    const Plain& accessors = list(root_, "accessors");
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= accessors.size()) return;
    const Plain& accessor = accessors[index.get<std::size_t>()];
    mark_view(member(accessor, "bufferView"), kind);
    const Plain& sparse = member(accessor, "sparse");
    mark_view(member(member(sparse, "indices"), "bufferView"), kind);
    mark_view(member(member(sparse, "values"), "bufferView"), kind);
  }

  void mark_meshes() {
    for (const Plain& mesh : list(root_, "meshes")) {
      for (const Plain& primitive : list(mesh, "primitives")) {
        const Plain& mode = member(primitive, "mode");
        const bool triangles = mode.is_null() || number(mode) >= 4;
        if (triangles) mark_primitive(primitive);
      }
    }
  }

  void mark_primitive(const Plain& primitive) {
    mark_accessor(member(primitive, "indices"), Kind::geometry);
    for (const Plain& attribute : member(primitive, "attributes")) mark_accessor(attribute, Kind::geometry);
    for (const Plain& target : list(primitive, "targets")) {
      for (const Plain& attribute : target) mark_accessor(attribute, Kind::geometry);
    }
    const Plain& draco = member(member(primitive, "extensions"), "KHR_draco_mesh_compression");
    mark_view(member(draco, "bufferView"), Kind::geometry);
  }

  void mark_images() {
    for (const Plain& image : list(root_, "images")) mark_view(member(image, "bufferView"), Kind::images);
  }

  void mark_animation() {
    for (const Plain& animation : list(root_, "animations")) {
      for (const Plain& sampler : list(animation, "samplers")) {
        mark_accessor(member(sampler, "input"), Kind::animation);
        mark_accessor(member(sampler, "output"), Kind::animation);
      }
    }
    for (const Plain& skin : list(root_, "skins")) {
      mark_accessor(member(skin, "inverseBindMatrices"), Kind::animation);
    }
  }

  // A compressed view's own length is that of the data once unpacked.
  std::uint64_t view_bytes(std::size_t index) const {
    const Plain& view = list(root_, "bufferViews")[index];
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      const Plain& compressed = member(member(view, "extensions"), name);
      if (compressed.is_object()) return number(member(compressed, "byteLength"));
    }
    return number(member(view, "byteLength"));
  }

  const Plain& root_;
  std::vector<Kind> kinds_;
};

std::string read_text(std::ifstream& in, std::uint64_t offset, std::uint64_t size) {
  std::string text(size, '\0');
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

// The JSON part of a .gltf or .glb, or null.
Plain read_json(std::ifstream& in, FileFormat format, std::uint64_t file_size) {
  std::uint64_t offset = 0, size = file_size;
  if (format == FileFormat::glb) {
    const std::string head = read_text(in, 0, 20);
    if (head.size() < 20) return {};
    const auto byte = [&](std::size_t i) {
      return static_cast<std::uint64_t>(static_cast<unsigned char>(head[i]));
    };
    offset = 20;
    size = std::min(byte(12) | byte(13) << 8 | byte(14) << 16 | byte(15) << 24, file_size - offset);
  }
  return Plain::parse(read_text(in, offset, size), nullptr, false);
}

// Bytes of the image files beside a glTF file.
std::uint64_t external_image_bytes(const GltfMeter& meter, const Model& model) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    if (meter.image_is_external(i)) sum += model.images[i].bytes.size();
  }
  return sum;
}

// What lies beside a file of another format, from what reading found.
void add_files_read(const fs::path& path, const Model& model, FileBytes& result) {
  std::uint64_t inside = 0;
  for (const EncodedImage& image : model.images) {
    result.kinds.images += image.bytes.size();
    (image.uri.empty() ? inside : result.files) += image.bytes.size();
  }
  result.kinds.geometry -= std::min(result.kinds.geometry, inside);
  std::error_code missing;
  const std::uint64_t materials = fs::file_size(fs::path(path).replace_extension(".mtl"), missing);
  if (!missing) result.files += materials;
}

// The files that writing left beside the first: materials and images.
void add_files_written(std::span<const fs::path> files, FileBytes& result) {
  for (const fs::path& file : files.subspan(1)) {
    const std::uint64_t size = fs::file_size(file);
    result.files += size;
    if (file.extension() != ".mtl") result.kinds.images += size;
  }
}

FileBytes measure(const fs::path& path, const Model& model, std::span<const fs::path> written) {
  std::ifstream in(path, std::ios::binary);
  std::error_code failed;
  const std::uint64_t size = fs::file_size(path, failed);
  if (!in || failed) throw Error(ErrorKind::input, "cannot read the file", path.string());

  const std::string head = read_text(in, 0, std::min<std::uint64_t>(size, kHead));
  in.clear();
  const FileFormat format = detect_format(std::as_bytes(std::span(head)), path);
  const bool gltf = format == FileFormat::gltf || format == FileFormat::glb;
  const Plain root = gltf ? read_json(in, format, size) : Plain();

  FileBytes result{format, size, {}};
  if (root.is_object()) {
    const GltfMeter meter(root);
    const std::uint64_t images = external_image_bytes(meter, model);
    result.kinds = meter.bytes();
    result.kinds.images += images;
    result.files += meter.external_buffer_bytes() + images;
  } else if (format == FileFormat::fovea) {
    for (const EncodedImage& image : model.images) result.kinds.images += image.bytes.size();
    result.kinds.geometry = size - std::min<std::uint64_t>(size, result.kinds.images);
  } else {
    result.kinds.geometry = size;
    written.empty() ? add_files_read(path, model, result) : add_files_written(written, result);
  }
  const std::uint64_t known = result.kinds.geometry + result.kinds.images + result.kinds.animation;
  result.kinds.other = result.files - std::min(result.files, known);
  return result;
}

}  // namespace

FileBytes measure_input(const fs::path& path, const Model& model) { return measure(path, model, {}); }

FileBytes measure_output(std::span<const fs::path> files, const Model& model) {
  return measure(files.front(), model, files);
}

}  // namespace fovea
