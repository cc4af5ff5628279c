#pragma once

#include <filesystem>

#include "fovea/model/image.h"

namespace fovea {

/// Throws what `write_image` would throw about its output alone: Error(usage) for an extension that is not
/// .png, .jpg, .jpeg or .webp and for an existing file without `force`, Error(output) for a folder that is
/// missing.
void check_image_output(const std::filesystem::path& path, bool force);

/// Writes an image in the format of the extension: PNG and WebP without loss, JPEG at quality 92; safely, as
/// io/write.h does. Throws Error(usage) if JPEG is given alpha.
void write_image(const Image8& image, const std::filesystem::path& path, bool force);

}  // namespace fovea
