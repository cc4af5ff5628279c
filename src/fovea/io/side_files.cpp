#include "fovea/io/side_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

std::string with_slashes(std::string_view name) {
  std::string result(name);
  std::replace(result.begin(), result.end(), '\\', '/');
  return result;
}

bool lies_inside(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

bool same_wrap(const Sampler& a, const Sampler& b) { return a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v; }

}  // namespace

std::optional<fs::path> find_inside(const fs::path& folder, std::string_view name) {
  const fs::path relative(with_slashes(name));
  // An embedded zero would end the path early in the operating system.
  if (name.empty() || relative.is_absolute() || name.find('\0') != std::string_view::npos) return {};
  std::error_code error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) return {};
  const fs::path file = fs::canonical(root / relative, error);
  if (error || !lies_inside(root, file) || !fs::is_regular_file(file, error)) return {};
  return file;
}

std::optional<fs::path> find_side_file(const fs::path& folder, std::string_view name) {
  if (auto file = find_inside(folder, name)) return file;
  return find_inside(folder, fs::path(with_slashes(name)).filename().string());
}

std::optional<int> TextureLoader::texture(std::string_view name, const Sampler& sampler,
                                          const std::string& place) {
  auto known = image_of_name_.find(name);
  if (known == image_of_name_.end()) {
    known = image_of_name_.emplace(name, load(std::string(name), place)).first;
  }
  if (known->second < 0) return {};
  return texture_of(known->second, sampler);
}

std::optional<int> TextureLoader::texture(std::string_view name, std::vector<std::uint8_t> encoded,
                                          const Sampler& sampler, const std::string& place) {
  auto known = image_of_name_.find(name);
  if (known == image_of_name_.end()) {
    EncodedImage image;
    image.name = name;
    image.bytes = std::move(encoded);
    known = image_of_name_.emplace(name, add(std::move(image), place)).first;
  }
  if (known->second < 0) return {};
  return texture_of(known->second, sampler);
}

bool TextureLoader::is_grey(std::string_view name) const {
  const auto file = find_side_file(folder_, name);
  if (!file) return false;
  const auto bytes = read_file(*file, options_.max_file_bytes);
  const int channels =
      image_info({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}).channels;
  return channels == 1 || channels == 2;
}

int TextureLoader::load(const std::string& name, const std::string& place) {
  const auto file = find_side_file(folder_, name);
  if (!file) {
    context_.report("missing-image", fmt::format("image \"{}\" is not in the model's folder", name), place);
    return -1;
  }
  // The same file may go by several names.
  if (const auto known = image_of_name_.find(file->string()); known != image_of_name_.end())
    return known->second;
  const auto bytes = read_file(*file, options_.max_file_bytes);
  EncodedImage image;
  image.name = file->stem().string();
  std::error_code error;
  image.uri =
      fs::relative(*file, fs::canonical(folder_.empty() ? "." : folder_, error), error).generic_string();
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  image.bytes.assign(data, data + bytes.size());
  return image_of_name_[file->string()] = add(std::move(image), place);
}

int TextureLoader::add(EncodedImage image, const std::string& place) {
  image.mime_type = image_info(image.bytes).mime_type;
  if (image.mime_type.empty()) {
    context_.report(
        "unknown-image",
        fmt::format("image \"{}\" is neither PNG, JPEG, WebP nor KTX2 and was left out", image.name), place);
    return -1;
  }
  model_.images.push_back(std::move(image));
  return static_cast<int>(model_.images.size()) - 1;
}

int TextureLoader::texture_of(int image, const Sampler& sampler) {
  int number = 0;
  for (const Texture& t : model_.textures) {
    if (t.image == image && same_wrap(model_.samplers[static_cast<std::size_t>(t.sampler)], sampler))
      return number;
    ++number;
  }
  int sampler_number = 0;
  for (const Sampler& s : model_.samplers) {
    if (same_wrap(s, sampler)) break;
    ++sampler_number;
  }
  if (sampler_number == static_cast<int>(model_.samplers.size())) model_.samplers.push_back(sampler);
  Texture texture;
  texture.image = image;
  texture.sampler = sampler_number;
  texture.name = model_.images[static_cast<std::size_t>(image)].name;
  model_.textures.push_back(texture);
  return number;
}

}  // namespace fovea
