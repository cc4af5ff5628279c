#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/model.h"
#include "fovea/texture/encode.h"

namespace fovea {

/// What files an image may become.
enum class TextureOutput { keep, png, jpeg, webp };

struct ShrinkOptions {
  double scale = 1;           ///< Of each side, above 0 up to 1.
  std::int64_t max_side = 0;  ///< Texels along the longer side at most; 0 for no limit.
  TextureOutput format = TextureOutput::keep;
  double psnr_db = 40;  ///< How near what a file decodes to has to be to what was encoded.
};
OptionList describe(ShrinkOptions& options);

/// One image before and after.
struct ImageChange {
  struct State {
    std::string mime_type;
    int width = 0, height = 0;
    std::uint64_t bytes = 0;
  };
  State before, after;
  double psnr_db = 0;        ///< Of the encoding, infinite without loss; 0 if the image was not encoded anew.
  std::string kept_because;  ///< Why it is as it was though it was to be smaller.
};

struct Shrunk {
  Model model;
  std::vector<ImageChange> images;  ///< [#images]
};

/// Makes the images of a model smaller, in texels and in bytes: each mixed as what it stands for
/// (`image_uses`, `resized`), encoded to an error (`encode_to_psnr`). An image's file never grows; where it
/// would, its quality is lowered if its format has one, else the image stays what it was. Images stay, and
/// are reported ("image-kept"), if no material uses them, if they are read in more than one way, and if they
/// cannot be decoded (KTX2, damaged).
///
/// JPEG is given to images whose alpha nobody reads; the others become PNG. WebP needs EXT_texture_webp,
/// which the writer adds. Sides are at least 1. One image after the other, each in parallel. Throws
/// Error(usage) for options out of range, Error(cancelled).
Shrunk shrink_textures(const Model& model, const ShrinkOptions& options, Context& context);

}  // namespace fovea
