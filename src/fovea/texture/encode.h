#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/model/image.h"

namespace fovea {

/// File formats that textures can be stored in.
enum class TextureFormat { png, jpeg, webp };

/// "image/png", "image/jpeg", "image/webp".
std::string mime_type(TextureFormat format);

struct EncodedTexture {
  std::vector<std::uint8_t> bytes;
  int quality = 0;     ///< 1 … 100; 0 without loss.
  double psnr_db = 0;  ///< Of what decodes, to the image that was given; infinite without loss.
};

/// What an image is, to the eye.
enum class Content {
  colors,  ///< Errors of brightness weigh six times those of each of the two colour differences.
  data     ///< Errors of all channels weigh the same.
};

/// Peak signal to noise ratio in dB of stored values, infinite for equal images: of BT.601's Y, Cb and Cr by
/// 6 : 1 : 1 for colours (the usual PSNR-YUV), alpha as a fourth channel beside them; of the channels as they
/// are for data. Of the whole image, or of the squares of 16² texels in which `a` shows something (values
/// differ by more than 8) and 2 dB more if that is less: thin lines on a black image count. `counted`
/// [height × width] is 0 for texels that do not count, as nothing shows them; all do if it is empty or none
/// would. Throws Error(usage) for images of different size or channels.
double encoding_psnr(const Image8& a, const Image8& b, Content content,
                     std::span<const std::uint8_t> counted = {});

/// A file of a quality of 1 … 100, or 0 without loss, which JPEG does not have.
std::vector<std::uint8_t> encode_texture(const Image8& image, TextureFormat format, int quality);
/// And its error as `encoding_psnr` counts.
EncodedTexture encode_at(const Image8& image, TextureFormat format, int quality, Content content,
                         std::span<const std::uint8_t> counted = {});

/// The smallest file of that format that decodes to at least `least_psnr_db` (`encoding_psnr`), or one
/// without loss if the format has such and none is near enough or it is smaller. JPEG does not store alpha,
/// which has to be opaque or of no use, and where 100 is not near enough it is 100. An infinite
/// `least_psnr_db` asks for no loss.
///
/// The quality is looked for on at most 512² texels, in tiles from all over the image that show something;
/// then the whole is encoded, again at a higher quality if it missed. Deterministic. Throws
/// Error(unsupported) for sides that the format does not have (WebP 16,383, JPEG 65,535).
EncodedTexture encode_to_psnr(const Image8& image, TextureFormat format, double least_psnr_db,
                              Content content, std::span<const std::uint8_t> counted = {});

}  // namespace fovea
