#include "fovea/io/image_file.h"

#include <string>
#include <vector>

#include "fovea/base/text.h"
#include "fovea/io/extension.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/write.h"

namespace fovea {

namespace {

constexpr int kJpegQuality = 92, kLossless = 101;

bool is_jpeg(const std::string& extension) { return extension == ".jpg" || extension == ".jpeg"; }

}  // namespace

void check_image_output(const std::filesystem::path& path, bool force) {
  check_extension(path, "pictures", {".png", ".jpg", ".jpeg", ".webp"});
  check_place(path, force);
}

void write_image(const Image8& image, const std::filesystem::path& path, bool force) {
  check_image_output(path, force);
  const std::string extension = lower_extension(path);
  const std::vector<std::uint8_t> bytes = is_jpeg(extension)     ? encode_jpeg(image, kJpegQuality)
                                          : extension == ".webp" ? encode_webp(image, kLossless)
                                                                 : encode_png(image);
  OutputFile file;
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  file.bytes.assign(data, data + bytes.size());
  write_files(path, {&file, 1}, force);
}

}  // namespace fovea
