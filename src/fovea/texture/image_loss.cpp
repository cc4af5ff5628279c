#include "fovea/texture/image_loss.h"

#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/seen_points.h"
#include "fovea/texture/texel_origin.h"

namespace fovea {

namespace {

constexpr std::size_t kMostSights = std::size_t{1} << 13;
constexpr std::size_t kSightGrain = 1024;

}  // namespace

ImageSights::ImageSights(const Model& model, std::span<const AtlasFace> faces,
                         std::span<const VertexField> field, std::vector<double> pixels)
    : pixels_(std::move(pixels)) {
  const std::vector<UvSlopes> slopes = picture_slopes(model, faces);
  for (const SurfacePoint& point : spread_points(model, faces, field, kMostSights))
    sights_.push_back({single(uv_at(faces[point.face], point.weights)), slopes[point.face], point.counts});
  if (!sights_.empty()) return;
  const auto side = static_cast<std::size_t>(std::sqrt(kMostSights));
  for (std::size_t i = 0; i < side * side; ++i) {
    const auto at = [&](std::size_t k) { return (static_cast<double>(k) + 0.5) / static_cast<double>(side); };
    sights_.push_back({single({at(i % side), at(i / side)}), {{1, 0}, {0, 1}}, 1});
  }
}

ImageLoss::ImageLoss(const ImageSights& sights, const Image8& image, const ImageUse& use,
                     const Context& context)
    : sights_(sights),
      meaning_(use.meaning),
      sampler_{.wrap_u = use.wrap_u, .wrap_v = use.wrap_v, .mag_filter = {}, .min_filter = {}, .json = {}},
      before_(looks(image, context)) {}

std::vector<Rgba> ImageLoss::looks(const Image8& image, const Context& context) const {
  const MipMap map = mip_map(image, meaning_);
  const std::size_t count = sights_.pixels().size();
  std::vector<Rgba> result(sights_.all().size() * count);
  parallel_for_or_throw(context, sights_.all().size(), kSightGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ImageSights::Sight& sight = sights_.all()[i];
      for (std::size_t p = 0; p < count; ++p)
        result[i * count + p] =
            shown(map.sample(sight.uv, scaled(sight.slopes, 1 / sights_.pixels()[p]), sampler_), meaning_);
    }
  });
  return result;
}

std::vector<double> ImageLoss::of(const Image8& other, const Context& context) const {
  const std::vector<Rgba> now = looks(other, context);
  const std::size_t count = sights_.pixels().size();
  std::vector<double> losses(count);
  double all = std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < sights_.all().size(); ++i) {
    const double counts = sights_.all()[i].counts;
    all += counts;
    for (std::size_t p = 0; p < count; ++p)
      losses[p] += counts * squared_difference(before_[i * count + p], now[i * count + p]);
  }
  for (double& loss : losses) loss /= all;
  return losses;
}

}  // namespace fovea
