#include "fovea/texture/image_ways.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/io/image_codec.h"
#include "fovea/texture/bake.h"

namespace fovea {

namespace {

constexpr int kLeastQuality = 15, kMostQuality = 98;

/// Of how many sizes, formats and fillings more qualities are tried.
constexpr std::size_t kFiner = 3;

/// From a quality that is tried to the next: small images are encoded in no time, and even colours may be met
/// better by less.
int quality_step(int width, int height) {
  const std::int64_t texels = std::int64_t{width} * height;
  if (texels <= (1 << 16)) return 3;
  return texels <= (1 << 18) ? 6 : 10;
}

/// An image of one size, and what of it triangles show.
struct Picture {
  Image8 image;
  std::vector<std::uint8_t> counted;
};

class Ways {
 public:
  Ways(const Image8& image, const ImageLimits& limits, std::span<const AtlasFace> faces,
       const ImageLoss& loss, const Context& context)
      : image_(image), limits_(limits), faces_(faces), loss_(loss), context_(context) {
    if (!faces.empty()) {
      filled_ = image;
      fill_between(filled_, faces, context);
      is_filled_ = filled_.pixels != image.pixels;
    }
  }

  std::vector<ImageWay> take() { return std::move(ways_); }
  bool empty() const { return ways_.empty(); }
  /// Whether one was added.
  bool add_size(int width, int height) {
    const std::size_t before = ways_.size();
    for (const bool fill : {true, false}) {
      if (fill && !may_fill(width)) continue;
      const Picture picture = sized(width, height, fill);
      add_qualities(picture, limits_.format, fill);
      if (limits_.format == TextureFormat::webp && !image_.has_alpha())
        add_qualities(picture, TextureFormat::jpeg, fill);
    }
    return ways_.size() > before;
  }

  void add_beside(const ImageWay& way) {
    const auto [format, quality, fill] = *way.file;
    const Picture picture = sized(way.width, way.height, fill);
    const int step = quality_step(way.width, way.height), finer = (step + 3) / 4;
    for (int q = quality - step + finer; q < quality + step; q += finer) {
      if (q > 0 && q <= 100 && q != quality) add(picture, {format, q, fill});
    }
  }

 private:
  bool may_fill(int width) const { return is_filled_ && width < image_.width; }

  Picture sized(int width, int height, bool fill) const {
    const Image8& from = fill ? filled_ : image_;
    const ImageUse& use = limits_.use;
    const bool same = width == from.width && height == from.height;
    return {same ? from : resized(from, width, height, use.meaning, use.wrap_u, use.wrap_v, context_),
            read_texels(faces_, width, height, context_)};
  }

  /// False if it takes too many bytes.
  bool add(const Picture& picture, const FileChoice& file) {
    const Image8& image = picture.image;
    const EncodedTexture texture =
        encode_at(image, file.format, file.quality, content_of(limits_.use), picture.counted);
    const auto bytes = static_cast<double>(texture.bytes.size());
    if (bytes >= limits_.most_bytes && !ways_.empty()) return false;
    ways_.push_back({image.width, image.height, file, texture.psnr_db, bytes,
                     loss_.of(file.quality == 0 ? image : decode_image(texture.bytes), context_)});
    return true;
  }

  void add_qualities(const Picture& picture, TextureFormat format, bool fill) {
    if (format == TextureFormat::png) {
      add(picture, {format, 0, fill});
      return;
    }
    const int step = quality_step(picture.image.width, picture.image.height);
    for (int quality = kLeastQuality; quality <= kMostQuality; quality += step) {
      if (!add(picture, {format, quality, fill})) return;
    }
    if (format == TextureFormat::webp) add(picture, {format, 0, fill});
  }

  const Image8& image_;
  const ImageLimits& limits_;
  std::span<const AtlasFace> faces_;
  const ImageLoss& loss_;
  const Context& context_;
  Image8 filled_;
  bool is_filled_ = false;  // differs from the image
  std::vector<ImageWay> ways_;
};

double sum_of_losses(const ImageWay& way) {
  return std::accumulate(way.losses.begin(), way.losses.end(), 0.0);
}

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

std::vector<ImageWay> image_ways(const Image8& image, const ImageLimits& limits,
                                 std::span<const AtlasFace> faces, const ImageLoss& loss,
                                 const Context& context) {
  Ways ways(image, limits, faces, loss, context);
  for (int k = limits.half_octaves; k >= 0; --k) {
    const auto side = [&](int whole) {
      return std::max(1, static_cast<int>(std::lround(whole * std::exp2(-0.5 * k))));
    };
    if (!ways.add_size(side(limits.width), side(limits.height))) break;
  }
  return ways.take();
}

std::vector<ImageWay> finer_ways(std::span<const ImageWay> ways, double bytes, const Image8& image,
                                 const ImageLimits& limits, std::span<const AtlasFace> faces,
                                 const ImageLoss& loss, const Context& context) {
  Ways finer(image, limits, faces, loss, context);
  for (const ImageWay* way : best_kinds(ways, bytes)) finer.add_beside(*way);
  return finer.take();
}

}  // namespace fovea
