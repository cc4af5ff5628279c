#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fovea {

/// What the numbers of an image mean: display values (sRGB curve) or quantities (normals, roughness).
enum class ColorEncoding { srgb, linear };

/// A picture in memory. Rows from top to bottom, channels interleaved (1 grey, 2 grey + alpha,
/// 3 RGB, 4 RGBA); [height × width × channels].
template <class T>
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  ColorEncoding encoding = ColorEncoding::srgb;
  std::vector<T> pixels;

  Image() = default;
  Image(int w, int h, int c, ColorEncoding e)
      : width(w),
        height(h),
        channels(c),
        encoding(e),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}
  bool has_alpha() const { return channels == 2 || channels == 4; }
  /// Channels without alpha.
  int color_channels() const { return has_alpha() ? channels - 1 : channels; }
  T* at(int x, int y) { return pixels.data() + offset(x, y); }
  const T* at(int x, int y) const { return pixels.data() + offset(x, y); }

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

using Image8 = Image<std::uint8_t>;  ///< 0 … 255
using ImageF = Image<float>;         ///< 0 … 1, beyond for high dynamic range

/// An image of a model as its file holds it: still encoded, so that what nobody changes is written
/// back bit for bit.
struct EncodedImage {
  std::string name;
  std::string mime_type;            ///< "image/png", "image/jpeg", "image/webp", "image/ktx2", ...
  std::string uri;                  ///< Relative path if it came from a file of its own; else empty.
  std::vector<std::uint8_t> bytes;  ///< The encoded file.
  std::string json;                 ///< glTF: the image object as read.
  friend bool operator==(const EncodedImage&, const EncodedImage&) = default;
};

}  // namespace fovea
