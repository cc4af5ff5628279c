#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/options.h"
#include "fovea/model/image.h"
#include "fovea/texture/encode.h"
#include "fovea/texture/image_use.h"

namespace fovea {

/// What files an image may become.
enum class TextureOutput { keep, png, jpeg, webp };

struct ImageOutputOptions {
  TextureOutput format = TextureOutput::keep;
  double psnr_db = 40;  ///< How near what a file decodes to has to be to what was encoded.
};
OptionList describe(ImageOutputOptions& options);

/// What the size of an image follows from.
enum class SizeReason {
  none,   ///< It is as it was.
  asked,  ///< A scale, or the longest side allowed.
  seen,   ///< What pictures show of it.
  bytes,  ///< What all files may take together.
};

/// What file an image becomes, where that is known beforehand.
struct FileChoice {
  TextureFormat format = TextureFormat::png;
  int quality = 0;   ///< As EncodedTexture's.
  bool fill = true;  ///< What lies between its charts is filled before the image gets smaller.
  friend bool operator==(const FileChoice&, const FileChoice&) = default;
};

/// How an image is to become.
struct WantedImage {
  int width = 0, height = 0;
  double psnr_db = 0;  ///< Of the encoding.
  bool stays = false;  ///< Its file does, unless texels move.
  SizeReason reason = SizeReason::none;
  std::optional<FileChoice> file = {};  ///< Instead of looking for what is as near as `psnr_db`.
  friend bool operator==(const WantedImage&, const WantedImage&) = default;
};

/// One image before and after.
struct ImageChange {
  struct State {
    std::string mime_type;
    int width = 0, height = 0;
    std::uint64_t bytes = 0;
  };
  State before, after;  ///< All of `before` is 0 for an image that was added.
  double psnr_db = 0;   ///< Of the encoding, infinite without loss; 0 if the image was not encoded anew.
  SizeReason reason = SizeReason::none;
  std::string kept_because;  ///< Why it is as it was though it was to be smaller.
};

/// What a file says of itself; sizes are 0 if it does not tell.
ImageChange::State state_of(const EncodedImage& image);

/// The format that an image gets.
TextureFormat output_format(const Image8& image, const std::string& mime_type,
                            const ImageOutputOptions& options);

/// What it is, to the eye.
Content content_of(const ImageUse& use);

/// Whether an image of that type would stay of it.
bool keeps_format(const std::string& mime_type, const ImageOutputOptions& options);

/// The image without an alpha channel that nobody reads or that hides nothing.
Image8 without_idle_alpha(Image8 image, const ImageUse& use);

/// An encoded file, smaller than `most_bytes`: of the wanted format and as near as asked, then at lower
/// quality; none if a format has no quality to lower. JPEG is given to images without alpha, others become
/// PNG; WebP, which has half the resolution for colours, gives way to JPEG where it could be near enough only
/// without loss. `mime_type` is that of the file before; `counted` as for `encoding_psnr`.
struct ImageOutput {
  EncodedTexture texture;
  TextureFormat format;
};
std::optional<ImageOutput> encode_output(const Image8& image, const ImageUse& use,
                                         const std::string& mime_type, std::uint64_t most_bytes,
                                         const ImageOutputOptions& options,
                                         std::span<const std::uint8_t> counted = {});

}  // namespace fovea
