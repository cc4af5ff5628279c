#include "fovea/io/gltf_images_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <map>
#include <string_view>

#include "fovea/base/error.h"
#include "fovea/base/text.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/uri.h"

namespace fovea::gltf {

namespace {

struct ImageType {
  const char* mime_type;
  const char* suffix;
};
constexpr ImageType kImageTypes[] = {
    {"image/png", ".png"},   {"image/jpeg", ".jpg"},  {"image/jpeg", ".jpeg"},     {"image/webp", ".webp"},
    {"image/ktx2", ".ktx2"}, {"image/avif", ".avif"}, {"image/vnd-ms.dds", ".dds"}};

/// Whether a file of that name may hold an image of that type. An unknown type may have any image's
/// suffix, but no other: a model must not choose to write "Makefile".
bool suffix_fits(const std::string& path, const std::string& mime_type) {
  constexpr std::string_view kOtherSuffixes[] = {".bmp",  ".gif", ".tga", ".tif",
                                                 ".tiff", ".hdr", ".exr", ".basis"};
  const std::string suffix = lower_extension(path);
  bool is_known_type = false,
       is_image = std::ranges::find(kOtherSuffixes, suffix) != std::end(kOtherSuffixes);
  for (const ImageType& type : kImageTypes) {
    if (mime_type == type.mime_type && suffix == type.suffix) return true;
    is_known_type = is_known_type || mime_type == type.mime_type;
    is_image = is_image || suffix == type.suffix;
  }
  return !is_known_type && is_image;
}

/// Empty if the path could leave the folder of the output.
std::string safe_path(const std::string& path) {
  if (path.empty() || path.find_first_of("\\:") != std::string::npos) return {};
  try {
    return relative_path_of_uri(percent_encode(path));
  } catch (const Error&) {
    return {};
  }
}

Json without_data(const EncodedImage& image) {
  Json object = parse_object(image.json);
  refresh(object, "name", image.name, "");
  for (const char* key : {"uri", "bufferView", "mimeType"}) object.erase(key);
  return object;
}

Bytes bytes_of(const EncodedImage& image) {
  const std::byte* begin = reinterpret_cast<const std::byte*>(image.bytes.data());
  return Bytes(begin, begin + image.bytes.size());
}

/// An image that was not found keeps its reference.
Json missing_image(const EncodedImage& image) {
  Json object = parse_object(image.json);
  object.erase("bufferView");
  refresh(object, "uri", image.uri.empty() ? Json() : Json(percent_encode(image.uri)));
  return object;
}

/// Names of files that are spoken for, with the image that has each.
class FileNames {
 public:
  FileNames(const std::vector<EncodedImage>& images, const std::string& stem) : images_(images) {
    for (const char* suffix : {".gltf", ".bin"}) {
      image_of_.try_emplace(lower_case(stem + suffix), std::string(), images.size());
    }
  }

  /// `wanted` or a name like it; the second says whether the file is still to be made.
  std::pair<std::string, bool> take(const std::string& wanted, std::size_t image) {
    const std::filesystem::path path(wanted);
    std::string name = wanted;
    for (int n = 2;; ++n) {
      // File systems may not tell upper case from lower case.
      const auto [at, is_new] = image_of_.try_emplace(lower_case(name), name, image);
      if (is_new) return {name, true};
      const auto& [taken, by] = at->second;
      if (by < images_.size() && images_[by].bytes == images_[image].bytes) return {taken, false};
      name = (path.parent_path() / fmt::format("{}_{}{}", path.stem().string(), n, path.extension().string()))
                 .generic_string();
    }
  }

 private:
  const std::vector<EncodedImage>& images_;
  std::map<std::string, std::pair<std::string, std::size_t>> image_of_;
};

}  // namespace

std::string percent_encode(const std::string& path) {
  std::string out;
  for (const char c : path) {
    const unsigned char u = static_cast<unsigned char>(c);
    // Letters beyond ASCII may stand as they are: glTF takes IRIs.
    const bool plain = u >= 0x80 || std::isalnum(u) != 0 || std::strchr("-._~/", c) != nullptr;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", u);
  }
  return out;
}

std::string image_suffix(const std::string& mime_type) {
  for (const ImageType& type : kImageTypes) {
    if (mime_type == type.mime_type) return type.suffix;
  }
  return ".png";
}

std::string image_type(const EncodedImage& image) {
  const std::string by_content = image_info(image.bytes).mime_type;
  return by_content.empty() ? image.mime_type : by_content;
}

Json embed_images(const std::vector<EncodedImage>& images, BufferWriter& buffers) {
  Json list = Json::array();
  for (const EncodedImage& image : images) {
    if (image.bytes.empty()) {
      list.push_back(missing_image(image));
      continue;
    }
    const std::string type = image_type(image);
    Json object = without_data(image);
    object["bufferView"] = buffers.add_view({bytes_of(image), ViewTarget::none, 0, 0}, ByteKind::images);
    object["mimeType"] = type.empty() ? "image/png" : type;
    list.push_back(std::move(object));
  }
  return list;
}

Json image_files(const std::vector<EncodedImage>& images, const std::string& stem,
                 std::vector<OutputFile>& files, ByteCounts& counts) {
  Json list = Json::array();
  FileNames names(images, stem);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const EncodedImage& image = images[i];
    if (image.bytes.empty()) {
      list.push_back(missing_image(image));
      continue;
    }
    const std::string type = image_type(image);
    std::string wanted = safe_path(image.uri);
    if (wanted.empty()) wanted = fmt::format("{}_image{}{}", stem, i, image_suffix(type));
    if (!suffix_fits(wanted, type)) {
      wanted = std::filesystem::path(wanted).replace_extension(image_suffix(type)).generic_string();
    }
    const auto [name, is_new] = names.take(wanted, i);
    Json object = without_data(image);
    object["uri"] = percent_encode(name);
    list.push_back(std::move(object));
    if (!is_new) continue;
    files.push_back({name, bytes_of(image)});
    counts.images += image.bytes.size();
  }
  return list;
}

}  // namespace fovea::gltf
