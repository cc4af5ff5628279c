#include "fovea/texture/image_ways.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "fovea/io/image_codec.h"
#include "fovea/texture/bake.h"

namespace fovea {

namespace {

constexpr int kLeastQuality = 15, kMostQuality = 98;

/// PNG has no quality, so it comes in more sizes: so many for each half.
constexpr int kPngSizes = 4;

/// Of how many sizes, formats and fillings more qualities are tried.
constexpr std::size_t kFiner = 3;
/// WebP has half the resolution for colours, so JPEG may be better: from this quality on.
constexpr int kLeastJpegQuality = 78;
/// A higher quality gains nothing where a file loses hardly more than the size alone does.
constexpr double kNearlyAll = 1.05;
/// A large image is both filled and as it is if the way that did worse with small ones loses so many times
/// less: halves keep what pictures showed of the texels between charts, and filled ones do not.
constexpr double kClearlyMore = 1.25;
/// Texels up to which images are both filled and as they are; up to which WebP is always tried without loss;
/// and up to which many qualities are tried.
constexpr std::int64_t kSmall = 1 << 16, kMiddle = 1 << 18, kLarge = 1 << 20;

/// From a quality that is tried to the next: small images are encoded in no time, and even colours may be met
/// better by less.
int quality_step(std::int64_t texels) {
  if (texels <= kSmall) return 3;
  if (texels <= kMiddle) return 6;
  return texels <= kLarge ? 12 : 20;
}

double sum_of_losses(const ImageWay& way) {
  return std::accumulate(way.losses.begin(), way.losses.end(), 0.0);
}

Image8 resized(const Image8& image, int width, int height, const ImageUse& use, const Context& context) {
  return resized(image, width, height, use.meaning, use.wrap_u, use.wrap_v, context);
}

bool is_by_quarter(const Image8& image, int width, int height) {
  return width * 8 <= image.width && height * 8 <= image.height;
}

Image8 quartered(const Image8& image, const ImageUse& use, const Context& context) {
  return resized(image, image.width / 4, image.height / 4, use, context);
}

/// A side `step / sizes` times halved.
int side_after(int whole, int step, int sizes) {
  const int halves = step / sizes, part = step % sizes;
  const int side = part == 0
                       ? whole >> halves
                       : static_cast<int>(std::lround((whole >> halves) * std::exp2(-double(part) / sizes)));
  return std::max(1, side);
}

class Ways {
 public:
  Ways(const Image8& image, const ImageLimits& limits, std::span<const AtlasFace> faces,
       const ImageLoss& loss, const Context& context)
      : image_(image), limits_(limits), loss_(loss), context_(context) {
    if (faces.empty()) return;
    filled_ = image;
    fill_between(filled_, faces, context);
    is_filled_ = filled_.pixels != image.pixels;
  }

  std::vector<ImageWay> take() { return std::move(ways_); }

  /// Whether one was added.
  bool add_size(int width, int height) {
    const std::size_t before = ways_.size();
    if (std::int64_t{width} * height <= kSmall) {
      for (const bool fill : {true, false})
        if (!fill || may_fill(width)) add_kind(filled_or_not(width, height, fill));
      largest_small_ = {before, ways_.size() - before};
      return ways_.size() > before;
    }
    const bool prefers = may_fill(width) && prefers_filled();
    const Kind preferred = filled_or_not(width, height, prefers);
    add_kind(preferred);
    if (may_fill(width)) {
      const Kind other = filled_or_not(width, height, !prefers);
      if (kClearlyMore * other.least_loss < preferred.least_loss) add_kind(other);
    }
    return ways_.size() > before;
  }

  /// The way of the highest quality between two that takes no more than so many bytes; none if none does.
  std::optional<ImageWay> fullest(const ImageWay& way, int fits, int too_much, double bytes) {
    FileChoice file = *way.file;
    const Image8 picture = sized(way.width, way.height, file.fill);
    std::vector<std::uint8_t> best;
    while (too_much - fits > 1) {
      const int middle = fits + (too_much - fits) / 2;
      std::vector<std::uint8_t> tried = encode_texture(picture, file.format, middle);
      const bool is_good = static_cast<double>(tried.size()) <= bytes;
      (is_good ? fits : too_much) = middle;
      if (is_good) best = std::move(tried);
    }
    if (best.empty()) return std::nullopt;
    file.quality = fits;
    return way_of(picture, file, best);
  }

  /// Qualities beside that of a way, but for those that are `known`.
  void add_beside(const ImageWay& way, std::span<const ImageWay> known) {
    const auto [format, quality, fill] = *way.file;
    const Image8 picture = sized(way.width, way.height, fill);
    const int step = quality_step(texels(picture)), finer = texels(picture) > kLarge    ? step / 2
                                                            : texels(picture) > kMiddle ? 3
                                                                                        : 1;
    for (int q = quality - step + finer; q < quality + step; q += finer) {
      const FileChoice file{format, q, fill};
      const auto is_it = [&](const ImageWay& other) {
        return other.width == way.width && other.file == file;
      };
      if (q > 0 && q <= 100 && std::ranges::none_of(known, is_it)) add(picture, file);
    }
  }

 private:
  static std::int64_t texels(const Image8& image) { return std::int64_t{image.width} * image.height; }

  /// That takes long, and is in vain for what came as a small file, as photographs do.
  bool may_be_without_loss(std::int64_t texels) const {
    constexpr double kLeastBytes = 1.0 / 3;  // for each texel
    return texels <= kMiddle ||
           (texels <= kLarge && limits_.most_bytes > kLeastBytes * static_cast<double>(texels));
  }

  bool may_fill(int width) const { return is_filled_ && width < image_.width; }

  /// By the largest of the small images: whether files lose and take less if it is filled.
  bool prefers_filled() const {
    std::map<std::pair<TextureFormat, int>, double> costs;
    double sum = 0;
    for (const ImageWay& way : std::span(ways_).subspan(largest_small_.first, largest_small_.count)) {
      const auto [format, quality, fill] = *way.file;
      const double cost = std::log(way.bytes) + std::log(sum_of_losses(way) + kLeastImageLoss);
      if (fill) {
        costs[{format, quality}] = cost;
      } else if (const auto filled = costs.find({format, quality}); filled != costs.end()) {
        sum += filled->second - cost;
      }
    }
    return sum <= 0;
  }

  Image8 sized(int width, int height, bool fill) {
    const Image8& whole = fill ? filled_ : image_;
    if (width == whole.width && height == whole.height) return whole;
    if (!is_by_quarter(whole, width, height)) return resized(whole, width, height, limits_.use, context_);
    Image8& quarter = fill ? filled_quarter_ : quarter_;
    if (quarter.width == 0) quarter = quartered(whole, limits_.use, context_);
    return resized(quarter, width, height, limits_.use, context_);
  }

  /// An image to encode, and what pictures lose by its size alone.
  struct Kind {
    Image8 picture;
    bool fill = false;
    double least_loss = 0;
  };

  Kind filled_or_not(int width, int height, bool fill) {
    Kind kind{sized(width, height, fill), fill};
    const std::vector<double> losses = loss_.of(kind.picture, context_);
    kind.least_loss = std::accumulate(losses.begin(), losses.end(), 0.0);
    return kind;
  }

  void add_kind(const Kind& kind) {
    const auto& [picture, fill, least] = kind;
    if (limits_.format == TextureFormat::png) {
      add(picture, {TextureFormat::png, 0, fill});
      return;
    }
    add_qualities(picture, {limits_.format, kLeastQuality, fill}, least);
    if (limits_.format != TextureFormat::webp) return;
    if (may_be_without_loss(texels(picture))) add(picture, {TextureFormat::webp, 0, fill});
    if (!image_.has_alpha()) add_qualities(picture, {TextureFormat::jpeg, kLeastJpegQuality, fill}, least);
  }

  /// From that of `file` on.
  void add_qualities(const Image8& picture, FileChoice file, double least_loss) {
    while (add(picture, file) && sum_of_losses(ways_.back()) > kNearlyAll * least_loss &&
           file.quality < kMostQuality)
      file.quality = std::min(file.quality + quality_step(texels(picture)), kMostQuality);
  }

  /// False if it takes too many bytes.
  bool add(const Image8& picture, const FileChoice& file) {
    const std::vector<std::uint8_t> encoded = encode_texture(picture, file.format, file.quality);
    if (static_cast<double>(encoded.size()) >= limits_.most_bytes && !ways_.empty()) return false;
    ways_.push_back(way_of(picture, file, encoded));
    return true;
  }

  ImageWay way_of(const Image8& picture, const FileChoice& file,
                  std::span<const std::uint8_t> encoded) const {
    return {picture.width, picture.height, file, static_cast<double>(encoded.size()),
            loss_.of(file.quality == 0 ? picture : decode_image(encoded), context_)};
  }

  const Image8& image_;
  const ImageLimits& limits_;
  const ImageLoss& loss_;
  const Context& context_;
  Image8 filled_;
  Image8 quarter_, filled_quarter_;  // a quarter of the sides; empty until needed
  bool is_filled_ = false;           // differs from the image
  struct {
    std::size_t first = 0, count = 0;
  } largest_small_;  // the ways of that image
  std::vector<ImageWay> ways_;
};

/// The best of each size, format and filling that takes no more than so many bytes: the best few of them.
std::vector<const ImageWay*> best_kinds(std::span<const ImageWay> ways, double bytes) {
  using Kind = std::tuple<int, TextureFormat, bool>;
  std::map<Kind, const ImageWay*> best;
  for (const ImageWay& way : ways) {
    if (!way.file || way.file->quality == 0 || way.bytes > bytes) continue;
    const ImageWay*& known = best[{way.width, way.file->format, way.file->fill}];
    if (known == nullptr || sum_of_losses(way) < sum_of_losses(*known)) known = &way;
  }
  std::vector<const ImageWay*> found;
  for (const auto& [kind, way] : best) found.push_back(way);
  std::ranges::stable_sort(found, {}, [](const ImageWay* way) { return sum_of_losses(*way); });
  found.resize(std::min(found.size(), kFiner));
  return found;
}

}  // namespace

Image8 resized_for_way(const Image8& image, int width, int height, const ImageUse& use,
                       const Context& context) {
  return is_by_quarter(image, width, height)
             ? resized(quartered(image, use, context), width, height, use, context)
             : resized(image, width, height, use, context);
}

std::vector<ImageWay> image_ways(const Image8& image, const ImageLimits& limits,
                                 std::span<const AtlasFace> faces, const ImageLoss& loss,
                                 const Context& context) {
  Ways ways(image, limits, faces, loss, context);
  const int sizes = limits.format == TextureFormat::png ? kPngSizes : 1;  // from a half to the next
  std::pair<int, int> last{0, 0};
  for (int step = kMostHalvings * sizes; step >= 0; --step) {
    const auto side = [&](int whole) { return side_after(whole, step, sizes); };
    const int width = side(image.width), height = side(image.height);
    if (width >= limits.width || height >= limits.height) break;
    if (width == last.first && height == last.second) continue;  // of images of few texels
    last = {width, height};
    if (!ways.add_size(width, height)) return ways.take();
  }
  ways.add_size(limits.width, limits.height);
  return ways.take();
}

Image8 sized_for_way(Image8 image, const ImageWay& way, const ImageUse& use, std::span<const AtlasFace> faces,
                     const Context& context) {
  if (way.width == image.width && way.height == image.height) return image;
  if (way.file->fill && !faces.empty()) fill_between(image, faces, context);
  return resized_for_way(image, way.width, way.height, use, context);
}

std::vector<ImageWay> finer_ways(std::span<const ImageWay> ways, double bytes, const Image8& image,
                                 const ImageLimits& limits, std::span<const AtlasFace> faces,
                                 const ImageLoss& loss, const Context& context) {
  Ways finer(image, limits, faces, loss, context);
  for (const ImageWay* way : best_kinds(ways, bytes)) finer.add_beside(*way, ways);
  std::vector<ImageWay> found = finer.take();
  std::erase_if(found, [&](const ImageWay& way) { return way.bytes >= limits.most_bytes; });
  return found;
}

std::optional<ImageWay> fullest_way(const ImageWay& way, std::span<const ImageWay> ways, double bytes,
                                    const Image8& image, const ImageLimits& limits,
                                    std::span<const AtlasFace> faces, const ImageLoss& loss,
                                    const Context& context) {
  if (!way.file || way.file->quality == 0) return std::nullopt;
  int too_much = kMostQuality + 1;
  for (const ImageWay& known : ways) {
    if (!known.file || known.width != way.width || known.bytes <= bytes) continue;
    const auto [format, quality, fill] = *known.file;
    if (format == way.file->format && fill == way.file->fill && quality > way.file->quality)
      too_much = std::min(too_much, quality);
  }
  return Ways(image, limits, faces, loss, context).fullest(way, way.file->quality, too_much, bytes);
}

}  // namespace fovea
