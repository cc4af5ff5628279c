#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea {

/// The file inside `folder` that the relative path `name` means ("/" or "\" between folders), if it
/// is an ordinary file and does not lie outside (after resolving ".." and symbolic links).
std::optional<std::filesystem::path> find_inside(const std::filesystem::path& folder, std::string_view name);

/// As `find_inside`; if that finds nothing, the file of the same name right in `folder`: many
/// material files hold the full path on the machine that made them.
std::optional<std::filesystem::path> find_side_file(const std::filesystem::path& folder,
                                                    std::string_view name);

/// Makes textures of a model from the image files beside it; every file is read once. What is
/// missing or cannot go into a model is a diagnostic ("missing-image", "unknown-image"), not an error.
class TextureLoader {
 public:
  TextureLoader(Model& model, std::filesystem::path folder, const ReadOptions& options, Context& context)
      : model_(model), folder_(std::move(folder)), options_(options), context_(context) {}

  /// Index of the texture of image file `name` with that wrapping, or none. `place` is for messages.
  std::optional<int> texture(std::string_view name, const Sampler& sampler, const std::string& place);
  /// As above for an image that the caller has in memory under `name`.
  std::optional<int> texture(std::string_view name, std::vector<std::uint8_t> encoded, const Sampler& sampler,
                             const std::string& place);
  /// Whether image file `name` is there and has no colour.
  bool is_grey(std::string_view name) const;

 private:
  int load(const std::string& name, const std::string& place);
  int add(EncodedImage image, const std::string& place);
  int texture_of(int image, const Sampler& sampler);

  Model& model_;
  std::filesystem::path folder_;
  const ReadOptions& options_;
  Context& context_;
  std::map<std::string, int, std::less<>> image_of_name_;  // -1 for those that failed
};

}  // namespace fovea
