#include "fovea/io/jpeg_codec.h"

#include <fmt/format.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
// Needs std::FILE and std::size_t before it.
#include <jpeglib.h>
// Needs jpeglib.h before it.
#include <jerror.h>

#include "fovea/base/error.h"

// libjpeg reports errors by longjmp. Functions that call setjmp here own nothing that has a destructor;
// results live in the frames of their callers.

namespace fovea {

namespace {

struct JpegFailure {
  jpeg_error_mgr manager;  // first, so that libjpeg's pointer to it is a pointer to this
  std::jmp_buf escape;
  std::array<char, JMSG_LENGTH_MAX> message{};
};

[[noreturn]] void on_error(j_common_ptr codec) {
  auto* failure = reinterpret_cast<JpegFailure*>(codec->err);
  codec->err->format_message(codec, failure->message.data());
  std::longjmp(failure->escape, 1);
}

/// libjpeg makes up what is missing at the end of a file; for us that is damage.
void on_message(j_common_ptr codec, int level) {
  const int code = codec->err->msg_code;
  if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) on_error(codec);
}

/// A small progressive file can ask for thousands of passes over a huge image.
void on_progress(j_common_ptr codec) {
  constexpr int kMaxScans = 500;
  if (!codec->is_decompressor) return;
  if (reinterpret_cast<j_decompress_ptr>(codec)->input_scan_number > kMaxScans) {
    ERREXIT(codec, JERR_BAD_PROGRESSION);
  }
}

jpeg_error_mgr* prepare(JpegFailure& failure) {
  jpeg_error_mgr* manager = jpeg_std_error(&failure.manager);
  manager->error_exit = on_error;
  manager->emit_message = on_message;
  return manager;
}

struct JpegReader {
  JpegFailure failure;
  jpeg_decompress_struct codec{};
  jpeg_progress_mgr progress{};

  JpegReader() { codec.err = prepare(failure); }
  ~JpegReader() { jpeg_destroy_decompress(&codec); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  bool start(std::span<const std::uint8_t> encoded) {
    if (setjmp(failure.escape)) return false;
    jpeg_create_decompress(&codec);
    progress.progress_monitor = on_progress;
    codec.progress = &progress;
    jpeg_mem_src(&codec, encoded.data(), static_cast<unsigned long>(encoded.size()));
    jpeg_read_header(&codec, TRUE);
    const bool is_inked = codec.jpeg_color_space == JCS_CMYK || codec.jpeg_color_space == JCS_YCCK;
    const bool is_grey = codec.jpeg_color_space == JCS_GRAYSCALE;
    codec.out_color_space = is_inked ? JCS_CMYK : is_grey ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(&codec);
    return true;
  }
  bool read_row(std::uint8_t* row) {
    if (setjmp(failure.escape)) return false;
    jpeg_read_scanlines(&codec, &row, 1);
    return true;
  }
  bool finish() {
    if (setjmp(failure.escape)) return false;
    jpeg_finish_decompress(&codec);
    return true;
  }
  [[noreturn]] void fail() const {
    throw Error(ErrorKind::format, fmt::format("the JPEG image is damaged: {}", failure.message.data()));
  }
};

/// Inks to light. Programs by Adobe, which are all that write such files, store 255 - ink.
void ink_row_to_rgb(const std::vector<std::uint8_t>& inks, bool inverted, std::uint8_t* rgb) {
  for (std::size_t x = 0; 4 * x < inks.size(); ++x) {
    const auto light = [&](std::size_t k) { return inverted ? inks[4 * x + k] : 255 - inks[4 * x + k]; };
    for (std::size_t k = 0; k < 3; ++k)
      rgb[3 * x + k] = static_cast<std::uint8_t>((light(k) * light(3) + 127) / 255);
  }
}

struct JpegWriter {
  JpegFailure failure;
  jpeg_compress_struct codec{};
  unsigned char* buffer = nullptr;
  unsigned long size = 0;

  JpegWriter() { codec.err = prepare(failure); }
  ~JpegWriter() {
    jpeg_destroy_compress(&codec);
    std::free(buffer);
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  bool write(const Image8& image, int quality) {
    constexpr int kFullColorQuality = 90;
    if (setjmp(failure.escape)) return false;
    jpeg_create_compress(&codec);
    jpeg_mem_dest(&codec, &buffer, &size);
    codec.image_width = static_cast<JDIMENSION>(image.width);
    codec.image_height = static_cast<JDIMENSION>(image.height);
    codec.input_components = image.channels;
    codec.in_color_space = image.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&codec);
    jpeg_set_quality(&codec, quality, TRUE);
    codec.optimize_coding = TRUE;
    if (quality >= kFullColorQuality) codec.comp_info[0].h_samp_factor = codec.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&codec, TRUE);
    for (int y = 0; y < image.height; ++y) {
      JSAMPROW row = const_cast<JSAMPROW>(image.at(0, y));
      jpeg_write_scanlines(&codec, &row, 1);
    }
    jpeg_finish_compress(&codec);
    return true;
  }
};

}  // namespace

Image8 decode_jpeg(std::span<const std::uint8_t> encoded, const ImageInfo& info) {
  JpegReader reader;
  if (!reader.start(encoded)) reader.fail();
  if (static_cast<int>(reader.codec.output_width) != info.width ||
      static_cast<int>(reader.codec.output_height) != info.height)
    throw Error(ErrorKind::format, "the JPEG image has more than one size");
  const bool is_inked = reader.codec.out_color_space == JCS_CMYK;
  Image8 image(static_cast<int>(reader.codec.output_width), static_cast<int>(reader.codec.output_height),
               is_inked ? 3 : reader.codec.output_components, ColorEncoding::srgb);
  std::vector<std::uint8_t> inks(is_inked ? std::size_t{4} * reader.codec.output_width : 0);
  for (int y = 0; y < image.height; ++y) {
    if (!reader.read_row(is_inked ? inks.data() : image.at(0, y))) reader.fail();
    if (is_inked) ink_row_to_rgb(inks, reader.codec.saw_Adobe_marker != 0, image.at(0, y));
  }
  if (!reader.finish()) reader.fail();
  return image;
}

std::vector<std::uint8_t> compress_jpeg(const Image8& image, int quality) {
  JpegWriter writer;
  if (!writer.write(image, quality)) {
    throw Error(ErrorKind::limit,
                fmt::format("cannot encode a JPEG image: {}", writer.failure.message.data()));
  }
  return {writer.buffer, writer.buffer + writer.size};
}

}  // namespace fovea
