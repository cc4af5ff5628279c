#include "fovea/io/image_codec.h"

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/random.h"

namespace fovea {
namespace {

/// Smooth in x and y with a hard edge, different in every channel.
Image8 picture(int width, int height, int channels) {
  Image8 image(width, height, channels, ColorEncoding::srgb);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y)[c] =
            static_cast<std::uint8_t>((x * 255 / width + y * 3 + c * 40 + (2 * x > width ? 30 : 0)) % 256);
      }
    }
  }
  return image;
}

/// Without jumps: what lossy coders are made for.
Image8 soft_picture(int width, int height, int channels) {
  Image8 image(width, height, channels, ColorEncoding::srgb);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y)[c] =
            static_cast<std::uint8_t>(128 + 100 * std::sin(0.05 * x + c) * std::cos(0.04 * y));
      }
    }
  }
  return image;
}

double mean_error(const Image8& a, const Image8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
  return sum / static_cast<double>(a.pixels.size());
}

void expect_kind(const std::vector<std::uint8_t>& encoded, ErrorKind kind, const std::string& what) {
  try {
    decode_image(encoded);
    ADD_FAILURE() << what << ": decoded";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind) << what << ": " << e.what();
  }
}

TEST(ImageCodec, PngIsLossless) {
  for (int channels = 1; channels <= 4; ++channels) {
    const Image8 image = picture(37, 21, channels);
    const auto encoded = encode_png(image);
    const ImageInfo info = image_info(encoded);
    EXPECT_EQ(info.mime_type, "image/png");
    EXPECT_EQ(info.width, 37);
    EXPECT_EQ(info.height, 21);
    EXPECT_EQ(info.channels, channels);
    const Image8 decoded = decode_image(encoded);
    EXPECT_EQ(decoded.channels, channels);
    EXPECT_EQ(decoded.pixels, image.pixels);
    EXPECT_EQ(encode_png(image), encoded);
  }
}

TEST(ImageCodec, WebpLosslessKeepsColorsUnderAlphaToo) {
  for (int channels = 1; channels <= 4; ++channels) {
    Image8 image = picture(33, 20, channels);
    if (channels == 4) image.at(0, 0)[3] = 0;
    const Image8 decoded = decode_image(encode_webp(image, 101));
    ASSERT_EQ(decoded.channels, channels == 2 || channels == 4 ? 4 : 3);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        EXPECT_EQ(decoded.at(x, y)[0], image.at(x, y)[0]);
        EXPECT_EQ(decoded.at(x, y)[decoded.channels - 1], image.at(x, y)[channels - 1]);
      }
    }
  }
}

TEST(ImageCodec, LossyCodersComeCloserWithQuality) {
  const Image8 image = soft_picture(160, 120, 3);
  for (const auto& encode : {encode_jpeg, encode_webp}) {
    const auto low = encode(image, 20), high = encode(image, 95);
    EXPECT_LT(low.size(), high.size());
    // One level of 255 is what rounding of colour transforms costs at high quality.
    EXPECT_LT(mean_error(decode_image(high), image), 1.0);
    EXPECT_LT(mean_error(decode_image(high), image), mean_error(decode_image(low), image));
    EXPECT_EQ(encode(image, 95), high);
  }
}

TEST(ImageCodec, JpegHeaderTellsSizeAndChannels) {
  for (const int channels : {1, 3}) {
    const ImageInfo info = image_info(encode_jpeg(soft_picture(50, 40, channels), 80));
    EXPECT_EQ(info.mime_type, "image/jpeg");
    EXPECT_EQ(info.width, 50);
    EXPECT_EQ(info.height, 40);
    EXPECT_EQ(info.channels, channels);
  }
}

TEST(ImageCodec, JpegKeepsFullColorFromQuality90On) {
  // Red and blue columns: halved colour resolution mixes them.
  Image8 image(64, 64, 3, ColorEncoding::srgb);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) image.at(x, y)[x % 2 == 0 ? 0 : 2] = 255;
  }
  EXPECT_GT(mean_error(decode_image(encode_jpeg(image, 89)), image), 40);
  EXPECT_LT(mean_error(decode_image(encode_jpeg(image, 90)), image), 20);
}

TEST(ImageCodec, WebpHeaderTellsAlpha) {
  EXPECT_EQ(image_info(encode_webp(picture(16, 16, 3), 80)).channels, 3);
  EXPECT_EQ(image_info(encode_webp(picture(16, 16, 4), 80)).channels, 4);
  EXPECT_EQ(image_info(encode_webp(picture(16, 16, 4), 80)).mime_type, "image/webp");
}

// ---- kinds of PNG that encode_png does not make ----

struct PngKind {
  int bits;
  int type;
  bool interlaced = false;
  bool transparent = false;
};

/// A PNG whose stored samples are x + y · width, modulo what fits.
std::vector<std::uint8_t> make_png(int width, int height, const PngKind& kind) {
  std::vector<std::uint8_t> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, std::size_t size) {
        auto* to = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(p));
        to->insert(to->end(), data, data + size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), kind.bits,
               kind.type, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
  std::vector<png_color> palette(16);
  for (std::size_t i = 0; i < 16; ++i) {
    palette[i] = {static_cast<png_byte>(i), static_cast<png_byte>(2 * i), static_cast<png_byte>(3 * i)};
  }
  if (kind.type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette.data(), 16);
  png_byte alphas[2] = {0, 128};
  if (kind.transparent) png_set_tRNS(png, info, alphas, 2, nullptr);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<std::vector<std::uint8_t>> rows;
  std::vector<png_bytep> pointers;
  for (int y = 0; y < height; ++y) {
    std::vector<std::uint8_t> row(row_bytes);
    for (std::size_t i = 0; i < row_bytes; ++i)
      row[i] = static_cast<std::uint8_t>(i + static_cast<std::size_t>(y) * row_bytes);
    rows.push_back(std::move(row));
  }
  for (auto& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

TEST(ImageCodec, PngOf16BitsIsRounded) {
  // Rows hold bytes 0, 1, 2, ...: samples 0x0001, 0x0203, ... of 65535.
  const Image8 image = decode_image(make_png(8, 1, {16, PNG_COLOR_TYPE_GRAY}));
  ASSERT_EQ(image.channels, 1);
  for (int x = 0; x < 8; ++x) {
    const int sample = (2 * x) * 256 + 2 * x + 1;
    EXPECT_EQ(image.at(x, 0)[0], std::lround(sample * 255.0 / 65535.0));
  }
}

TEST(ImageCodec, PngOf16BitsKeepsThemWhereAsked) {
  const ImageF image = decode_deep_image(make_png(8, 2, {16, PNG_COLOR_TYPE_GRAY}));
  ASSERT_EQ(image.channels, 1);
  for (int i = 0; i < 16; ++i) {
    const int sample = (2 * i) * 256 + 2 * i + 1;
    EXPECT_EQ(image.pixels[static_cast<std::size_t>(i)], static_cast<float>(sample) / 65535);
  }
  // Others are as they are.
  for (const auto& encoded :
       {make_png(4, 2, {8, PNG_COLOR_TYPE_RGB}), make_png(4, 1, {4, PNG_COLOR_TYPE_PALETTE}),
        encode_jpeg(picture(16, 8, 3), 90)}) {
    const Image8 plain = decode_image(encoded);
    const ImageF deep = decode_deep_image(encoded);
    ASSERT_EQ(deep.pixels.size(), plain.pixels.size());
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
      EXPECT_EQ(deep.pixels[i], static_cast<float>(plain.pixels[i]) / 255);
  }
  EXPECT_THROW(decode_deep_image(make_png(8, 2, {16, PNG_COLOR_TYPE_GRAY}), 15), Error);
}

TEST(ImageCodec, PngPalettesAreExpanded) {
  // 4 bits per pixel: the first byte, 0, is two pixels of colour 0, the second, 1, colours 0 and 1.
  const Image8 image = decode_image(make_png(4, 1, {4, PNG_COLOR_TYPE_PALETTE}));
  ASSERT_EQ(image.channels, 3);
  EXPECT_EQ(image.at(3, 0)[0], 1);
  EXPECT_EQ(image.at(3, 0)[1], 2);
  EXPECT_EQ(image.at(3, 0)[2], 3);
  const auto transparent = make_png(4, 1, {4, PNG_COLOR_TYPE_PALETTE, false, true});
  EXPECT_EQ(image_info(transparent).channels, 4);
  const Image8 with_alpha = decode_image(transparent);
  ASSERT_EQ(with_alpha.channels, 4);
  EXPECT_EQ(with_alpha.at(0, 0)[3], 0);
  EXPECT_EQ(with_alpha.at(3, 0)[3], 128);
}

TEST(ImageCodec, PngOfOneBitIsBlackAndWhite) {
  const Image8 image = decode_image(make_png(16, 1, {1, PNG_COLOR_TYPE_GRAY}));
  EXPECT_EQ(image.at(14, 0)[0], 0);
  EXPECT_EQ(image.at(15, 0)[0], 255);  // bytes 0 and 1
}

TEST(ImageCodec, InterlacedPngIsTheSamePicture) {
  const auto plain = make_png(19, 13, {8, PNG_COLOR_TYPE_RGB}),
             interlaced = make_png(19, 13, {8, PNG_COLOR_TYPE_RGB, true});
  EXPECT_NE(plain, interlaced);
  EXPECT_EQ(decode_image(plain).pixels, decode_image(interlaced).pixels);
}

TEST(ImageCodec, JpegOfInksAndInScansIsRead) {
  // Red to the left and blue to the right, by four inks as printers have them (inverted, as is usual), and
  // stored in scans that get finer.
  for (const char* const name : {"cmyk.jpg", "progressive.jpg"}) {
    std::ifstream file(std::string(FOVEA_TEST_FIXTURES "/") + name, std::ios::binary);
    const std::vector<std::uint8_t> encoded{std::istreambuf_iterator<char>(file), {}};
    const Image8 image = decode_image(encoded);
    ASSERT_EQ(image.width, 24) << name;
    ASSERT_EQ(image.height, 16);
    ASSERT_EQ(image.channels, 3);
    const std::array<int, 3> red{0xD0, 0x20, 0x40}, blue{0x20, 0x60, 0xC0};
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(image.at(4, 8)[k], red[k], 3) << name;
      EXPECT_NEAR(image.at(19, 8)[k], blue[k], 3) << name;
    }
  }
}

// ---- damage ----

TEST(ImageCodec, EveryTruncationIsRefused) {
  const Image8 image = soft_picture(40, 30, 3);
  const std::vector<std::vector<std::uint8_t>> files = {encode_png(image), encode_jpeg(image, 80),
                                                        encode_webp(image, 80)};
  const std::size_t magic_sizes[] = {8, 3, 12};
  for (std::size_t f = 0; f < files.size(); ++f) {
    for (std::size_t size = 0; size + 2 < files[f].size(); size += 1 + files[f].size() / 150) {
      const std::vector<std::uint8_t> cut(files[f].begin(), files[f].begin() + static_cast<long>(size));
      expect_kind(cut, size < magic_sizes[f] ? ErrorKind::unsupported : ErrorKind::format,
                  std::to_string(f) + " cut to " + std::to_string(size));
    }
  }
}

TEST(ImageCodec, FlippedBytesNeverCrash) {
  const Image8 image = soft_picture(40, 30, 3);
  Random random(7);
  std::size_t refused = 0;
  for (const auto& file : {encode_png(image), encode_jpeg(image, 80), encode_webp(image, 80)}) {
    for (int i = 0; i < 400; ++i) {
      auto damaged = file;
      for (int k = 0; k < 3; ++k) {
        damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
            static_cast<std::uint8_t>(random.below(256));
      }
      const ImageInfo info = image_info(damaged);
      try {
        const Image8 decoded = decode_image(damaged, 1 << 20);
        EXPECT_EQ(decoded.width, info.width);
        EXPECT_EQ(decoded.height, info.height);
      } catch (const Error& e) {
        EXPECT_NE(e.kind(), ErrorKind::internal) << e.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 400u);  // every damaged PNG at least, for its checksums
}

TEST(ImageCodec, InfoOfNoiseIsEmpty) {
  EXPECT_TRUE(image_info({}).mime_type.empty());
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> noise(random.below(64));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.below(256));
    if (noise.size() > 2 && i % 2 == 0) std::memcpy(noise.data(), "\xFF\xD8\xFF", 3);
    const ImageInfo info = image_info(noise);
    EXPECT_EQ(info.mime_type.empty(), info.width == 0);
  }
}

TEST(ImageCodec, LimitOnPixelsHolds) {
  const auto encoded = encode_png(picture(100, 100, 1));
  EXPECT_NO_THROW(decode_image(encoded, 10'000));
  try {
    decode_image(encoded, 9'999);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::limit);
  }
}

TEST(ImageCodec, Ktx2IsKnownButNotDecoded) {
  std::vector<std::uint8_t> ktx2(80);
  std::memcpy(ktx2.data(), "\xABKTX 20\xBB\r\n\x1A\n", 12);
  ktx2[20] = 64;
  ktx2[25] = 1;
  const ImageInfo info = image_info(ktx2);
  EXPECT_EQ(info.mime_type, "image/ktx2");
  EXPECT_EQ(info.width, 64);
  EXPECT_EQ(info.height, 256);
  expect_kind(ktx2, ErrorKind::unsupported, "ktx2");
}

TEST(ImageCodec, WrongOptionsAreTheUsersFault) {
  const auto expect_usage = [](const auto& call) {
    try {
      call();
      ADD_FAILURE();
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::usage);
    }
  };
  expect_usage([] { encode_jpeg(picture(8, 8, 4), 80); });
  expect_usage([] { encode_jpeg(picture(8, 8, 3), 0); });
  expect_usage([] { encode_jpeg(picture(8, 8, 3), 101); });
  expect_usage([] { encode_webp(picture(8, 8, 3), 102); });
  expect_usage([] { encode_png(Image8{}); });
}

// What stands in front must not hide the size from the limit on pixels.
TEST(ImageCodec, JpegMarkersThatStandAloneHaveNoLength) {
  const Image8 image(16, 8, 3, ColorEncoding::srgb);
  std::vector<std::uint8_t> bytes = encode_jpeg(image, 90);
  const std::vector<std::uint8_t> restart{0xFF, 0xD0, 0xFF, 0x01};
  bytes.insert(bytes.begin() + 2, restart.begin(), restart.end());
  EXPECT_EQ(image_info(bytes).width, 16);
  EXPECT_EQ(image_info(bytes).height, 8);
  EXPECT_EQ(decode_image(bytes).width, 16);
}

}  // namespace
}  // namespace fovea
