#include "fovea/io/png_codec.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "fovea/base/error.h"

// libpng reports errors by longjmp. Functions that call setjmp here own nothing that has a destructor, and
// what their callbacks own is gone before they jump; results live in the frames of their callers.

namespace fovea {

namespace {

constexpr std::size_t kMessageSize = 160;

struct PngFailure {
  std::array<char, kMessageSize> message{};
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto* failure = static_cast<PngFailure*>(png_get_error_ptr(png));
  std::snprintf(failure->message.data(), failure->message.size(), "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

struct Source {
  const std::uint8_t* data;
  std::size_t left;
};

void on_read(png_structp png, png_bytep to, std::size_t count) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (count > source->left) png_error(png, "the file ends early");
  std::memcpy(to, source->data, count);
  source->data += count;
  source->left -= count;
}

/// A libpng reader and its input.
struct PngReader {
  PngFailure failure;
  Source source;
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit PngReader(std::span<const std::uint8_t> encoded) : source{encoded.data(), encoded.size()} {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, on_error, on_warning);
    if (png) info = png_create_info_struct(png);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// Up to the first pixel, with everything set for 8 bits per channel, or 16 where the file has them and
  /// `is_deep`, and no palette.
  bool read_header(bool is_deep) {
    if (!info || setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, &source, on_read);
    png_read_info(png, info);
    png_set_expand(png);
    if (is_deep) {
      png_set_swap(png);  // the file has the high byte first
    } else {
      png_set_scale_16(png);
    }
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
  }
  bool read_rows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
  }
  [[noreturn]] void fail() const {
    throw Error(ErrorKind::format, fmt::format("the PNG image is damaged: {}", failure.message.data()));
  }
};

/// The beginnings of rows in `pixels`.
std::vector<png_bytep> rows_of(std::uint8_t* pixels, int height, std::size_t row_bytes) {
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) rows.push_back(pixels + static_cast<std::size_t>(y) * row_bytes);
  return rows;
}

/// An image of the size that a header tells.
template <class T>
Image<T> sized(const PngReader& reader) {
  return Image<T>(static_cast<int>(png_get_image_width(reader.png, reader.info)),
                  static_cast<int>(png_get_image_height(reader.png, reader.info)),
                  static_cast<int>(png_get_channels(reader.png, reader.info)), ColorEncoding::srgb);
}

void on_write(png_structp png, png_bytep from, std::size_t count) {
  auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  out->insert(out->end(), from, from + count);
}

void on_flush(png_structp) {}

struct PngWriter {
  PngFailure failure;
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, on_error, on_warning);
    if (png) info = png_create_info_struct(png);
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  bool write(const Image8& image, std::vector<std::uint8_t>& out) {
    static constexpr int kTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                     PNG_COLOR_TYPE_RGB_ALPHA};
    if (!info || setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &out, on_write, on_flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                 kTypes[image.channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < image.height; ++y) png_write_row(png, image.at(0, y));
    png_write_end(png, info);
    return true;
  }
};

}  // namespace

Image8 decode_png(std::span<const std::uint8_t> encoded) {
  PngReader reader(encoded);
  if (!reader.read_header(false)) reader.fail();
  auto image = sized<std::uint8_t>(reader);
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  if (row_bytes != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels)) {
    throw Error(ErrorKind::internal, "a PNG image was not reduced to 8 bits");
  }
  std::vector<png_bytep> rows = rows_of(image.pixels.data(), image.height, row_bytes);
  if (!reader.read_rows(rows.data())) reader.fail();
  return image;
}

ImageF decode_deep_png(std::span<const std::uint8_t> encoded) {
  PngReader reader(encoded);
  if (!reader.read_header(true)) reader.fail();
  auto image = sized<float>(reader);
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  const std::size_t numbers =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  const bool is_deep = row_bytes == 2 * numbers;
  if (!is_deep && row_bytes != numbers) {
    throw Error(ErrorKind::internal, "a PNG image was not reduced to whole bytes");
  }
  std::vector<std::uint8_t> bytes(row_bytes * static_cast<std::size_t>(image.height));
  std::vector<png_bytep> rows = rows_of(bytes.data(), image.height, row_bytes);
  if (!reader.read_rows(rows.data())) reader.fail();
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const int low = bytes[is_deep ? 2 * i : i], high = is_deep ? bytes[2 * i + 1] : 0;
    image.pixels[i] = static_cast<float>(low + 256 * high) / (is_deep ? 65535.0f : 255.0f);
  }
  return image;
}

std::vector<std::uint8_t> compress_png(const Image8& image) {
  std::vector<std::uint8_t> out;
  PngWriter writer;
  if (!writer.write(image, out)) {
    throw Error(ErrorKind::limit,
                fmt::format("cannot encode a PNG image: {}", writer.failure.message.data()));
  }
  return out;
}

}  // namespace fovea
