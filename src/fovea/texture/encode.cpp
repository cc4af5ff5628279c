#include "fovea/texture/encode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/image_error.h"

namespace fovea {

namespace {

/// Tiles that stand for an image, in texels, and how many of them are side by side at most.
constexpr int kTile = 64, kTilesAcross = 8;
/// Squares whose error is looked at, in texels; nothing is to be seen where values are no further apart than
/// kEven. Where something is, a file may be worse than asked for by so many dB.
constexpr int kSquare = 16, kEven = 8;
constexpr double kBusyDb = 2;
constexpr double kNoLoss = std::numeric_limits<double>::infinity();

/// An image and which of its texels count: none are named if all do.
struct Counted {
  const Image8& image;
  std::span<const std::uint8_t> texels;

  bool counts(int x, int y) const {
    return texels.empty() || texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(x)] != 0;
  }
};

/// All texels instead of none.
Counted with_any(const Counted& of) {
  const bool any = std::ranges::any_of(of.texels, [](std::uint8_t c) { return c != 0; });
  return {of.image, any ? of.texels : std::span<const std::uint8_t>{}};
}

/// A part of an image: columns [x0, x1), rows [y0, y1).
struct Square {
  int x0, y0, x1, y1;
};

struct SquaredError {
  double sum = 0;
  std::int64_t texels = 0;

  double mean() const { return sum / static_cast<double>(texels); }
  SquaredError& operator+=(const SquaredError& other) {
    sum += other.sum;
    texels += other.texels;
    return *this;
  }
};

/// `error` of two texels, summed over what counts of a part of two images.
template <class F>
SquaredError summed(const Counted& a, const Image8& b, const Square& square, const F& error) {
  SquaredError result;
  for (int y = square.y0; y < square.y1; ++y) {
    for (int x = square.x0; x < square.x1; ++x) {
      if (!a.counts(x, y)) continue;
      result.sum += error(a.image.at(x, y), b.at(x, y));
      ++result.texels;
    }
  }
  return result;
}

SquaredError color_error(const Counted& a, const Image8& b, const Square& square) {
  return summed(a, b, square, [&](const std::uint8_t* p, const std::uint8_t* q) {
    const auto off = [&](std::size_t k) { return static_cast<double>(p[k]) - q[k]; };
    const double y = 0.299 * off(0) + 0.587 * off(1) + 0.114 * off(2);
    const double cb = 0.564 * (off(2) - y), cr = 0.713 * (off(0) - y);
    const double colors = (6 * y * y + cb * cb + cr * cr) / 8;
    return b.channels == 4 ? (3 * colors + off(3) * off(3)) / 4 : colors;
  });
}

SquaredError data_error(const Counted& a, const Image8& b, const Square& square) {
  return summed(a, b, square, [&](const std::uint8_t* p, const std::uint8_t* q) {
    double sum = 0;
    for (int k = 0; k < b.channels; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]);
    return sum / b.channels;
  });
}

/// Nothing is to be seen in it.
bool is_even(const Image8& image, const Square& square) {
  std::array<std::uint8_t, 4> low{255, 255, 255, 255}, high{};
  for (int y = square.y0; y < square.y1; ++y) {
    for (int x = square.x0; x < square.x1; ++x) {
      for (int k = 0; k < image.channels; ++k) {
        const auto c = static_cast<std::size_t>(k);
        low[c] = std::min(low[c], image.at(x, y)[k]);
        high[c] = std::max(high[c], image.at(x, y)[k]);
      }
    }
  }
  for (std::size_t c = 0; c < static_cast<std::size_t>(image.channels); ++c) {
    if (high[c] - low[c] > kEven) return false;
  }
  return true;
}

bool counts(const Counted& of, const Square& square) {
  for (int y = square.y0; y < square.y1; ++y) {
    for (int x = square.x0; x < square.x1; ++x) {
      if (of.counts(x, y)) return true;
    }
  }
  return false;
}

/// Decoders may turn grey into colours, or leave out alpha that is opaque.
Image8 with_channels(const Image8& image, int channels) {
  if (image.channels == channels) return image;
  Image8 result(image.width, image.height, channels, image.encoding);
  const bool alpha = result.has_alpha(), had_alpha = image.has_alpha();
  const int colors = result.color_channels(), had = image.color_channels();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* from = image.at(x, y);
      std::uint8_t* to = result.at(x, y);
      for (int k = 0; k < colors; ++k) to[k] = from[std::min(k, had - 1)];
      if (alpha) to[colors] = had_alpha ? from[had] : 255;
    }
  }
  return result;
}

struct Excerpt {
  Image8 image;
  std::vector<std::uint8_t> counted;  // empty if all is
};

/// Squares of kTile² from all over what counts of the image, in which something is to be seen if there are
/// such, side by side; all of the image if it is not larger.
Excerpt excerpt(const Counted& of) {
  const Image8& image = of.image;
  constexpr int kSide = kTile * kTilesAcross;
  if (image.width <= kSide && image.height <= kSide)
    return {image, std::vector<std::uint8_t>(of.texels.begin(), of.texels.end())};
  const int width = std::min(kTile, image.width), height = std::min(kTile, image.height);
  std::vector<Square> tiles, counted, busy;
  for (int y = 0; y + height <= image.height; y += height) {
    for (int x = 0; x + width <= image.width; x += width) {
      const Square& tile = tiles.emplace_back(Square{x, y, x + width, y + height});
      if (!counts(of, tile)) continue;
      counted.push_back(tile);
      if (!is_even(image, tile)) busy.push_back(tile);
    }
  }
  if (!counted.empty()) tiles = std::move(counted);
  if (!busy.empty()) tiles = std::move(busy);
  const std::size_t count = std::min(tiles.size(), static_cast<std::size_t>(kTilesAcross * kTilesAcross));
  const auto across = static_cast<int>(std::min(count, static_cast<std::size_t>(kTilesAcross)));
  const int down = static_cast<int>(count) / across;
  Excerpt result{Image8(across * width, down * height, image.channels, image.encoding), {}};
  if (!of.texels.empty())
    result.counted.resize(result.image.pixels.size() / static_cast<std::size_t>(image.channels));
  for (int i = 0; i < across * down; ++i) {
    const Square& tile =
        tiles[static_cast<std::size_t>(i) * tiles.size() / static_cast<std::size_t>(across * down)];
    for (int y = 0; y < height; ++y) {
      const int to_x = i % across * width, to_y = i / across * height + y;
      std::copy_n(image.at(tile.x0, tile.y0 + y), width * image.channels, result.image.at(to_x, to_y));
      for (int x = 0; x < width && !of.texels.empty(); ++x)
        result.counted[static_cast<std::size_t>(to_y) * static_cast<std::size_t>(across * width) +
                       static_cast<std::size_t>(to_x + x)] = of.counts(tile.x0 + x, tile.y0 + y) ? 1 : 0;
    }
  }
  return result;
}

/// The lowest quality of 1 … 100 at which an image is near enough, or 100.
int lowest_quality(const Counted& of, TextureFormat format, double least_psnr_db, Content content) {
  int low = 1, high = 100;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (encode_at(of.image, format, middle, content, of.texels).psnr_db >= least_psnr_db) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace

std::string mime_type(TextureFormat format) {
  switch (format) {
    case TextureFormat::png: return "image/png";
    case TextureFormat::jpeg: return "image/jpeg";
    case TextureFormat::webp: return "image/webp";
  }
  throw Error(ErrorKind::internal, "an unknown format of textures");
}

double encoding_psnr(const Image8& a, const Image8& b, Content content,
                     std::span<const std::uint8_t> counted) {
  check_same_shape(a, b);
  const Counted of = with_any({a, counted});
  const bool is_color = content == Content::colors && a.channels >= 3;
  SquaredError all, busy;
  for (int y = 0; y < a.height; y += kSquare) {
    for (int x = 0; x < a.width; x += kSquare) {
      const Square square{x, y, std::min(x + kSquare, a.width), std::min(y + kSquare, a.height)};
      const SquaredError error = is_color ? color_error(of, b, square) : data_error(of, b, square);
      all += error;
      if (!is_even(a, square)) busy += error;
    }
  }
  const double whole = psnr(all.mean());
  return busy.texels > 0 ? std::min(whole, psnr(busy.mean()) + kBusyDb) : whole;
}

std::vector<std::uint8_t> encode_texture(const Image8& image, TextureFormat format, int quality) {
  switch (format) {
    case TextureFormat::png: return encode_png(image);
    case TextureFormat::jpeg: return encode_jpeg(image, quality);
    case TextureFormat::webp: return encode_webp(image, quality == 0 ? 101 : quality);
  }
  throw Error(ErrorKind::internal, "an unknown format of textures");
}

EncodedTexture encode_at(const Image8& image, TextureFormat format, int quality, Content content,
                         std::span<const std::uint8_t> counted) {
  if (quality == 0) return {encode_texture(image, format, 0), 0, kNoLoss};
  EncodedTexture result{encode_texture(image, format, quality), quality, 0};
  const Image8 decoded = with_channels(decode_image(result.bytes), image.channels);
  result.psnr_db = encoding_psnr(image, decoded, content, counted);
  return result;
}

EncodedTexture encode_to_psnr(const Image8& image, TextureFormat format, double least_psnr_db,
                              Content content, std::span<const std::uint8_t> counted) {
  const auto without_loss = [&] { return encode_at(image, format, 0, content); };
  if (format == TextureFormat::png) return without_loss();
  if (!std::isfinite(least_psnr_db))
    return format == TextureFormat::webp ? without_loss() : encode_at(image, format, 100, content, counted);
  const Excerpt part = excerpt({image, counted});
  int quality = lowest_quality({part.image, part.counted}, format, least_psnr_db, content);
  EncodedTexture result = encode_at(image, format, quality, content, counted);
  // The excerpt is not the whole: some steps more may be needed.
  for (int step = 2; result.psnr_db < least_psnr_db && quality < 100; step *= 2) {
    quality = std::min(quality + step, 100);
    result = encode_at(image, format, quality, content, counted);
  }
  if (format == TextureFormat::jpeg) return result;
  if (result.psnr_db < least_psnr_db) return without_loss();
  // Drawings and even colours are often smaller without loss.
  if (encode_texture(part.image, format, 0).size() >= encode_texture(part.image, format, quality).size())
    return result;
  EncodedTexture exact = without_loss();
  return exact.bytes.size() < result.bytes.size() ? exact : result;
}

}  // namespace fovea
