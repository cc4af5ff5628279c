#include "fovea/texture/seen_loss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/tangent_frame.h"

namespace fovea {

namespace {

constexpr std::size_t kPoints = std::size_t{1} << 16;
/// Half a step of a byte.
constexpr double kLeastDistance = 0.5 / 255, kLeastLoss = kLeastDistance * kLeastDistance;

}  // namespace

void PictureLosses::add(const PictureLosses& other, double weight) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] += weight * other.all[i];
    color[i] += weight * other.color[i];
    distance[i] += weight * other.distance[i];
  }
}

double PictureLosses::mean() const {
  double product = 1;
  for (std::size_t i = 0; i < all.size(); ++i)
    product *= std::max(all[i], kLeastLoss) * std::max(color[i], kLeastLoss);
  return std::pow(product, 0.5 / static_cast<double>(all.size()));
}

bool PictureLosses::is_nothing() const { return !is_worse_somewhere({}); }

bool PictureLosses::is_worse_somewhere(const PictureLosses& than) const {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] > std::max(than.all[i], kLeastLoss) || color[i] > std::max(than.color[i], kLeastLoss) ||
        distance[i] > std::max(than.distance[i], kLeastDistance))
      return true;
  }
  return false;
}

SeenLoss::SeenLoss(const Model& model, std::vector<AtlasFace> faces, std::vector<MipMap> images,
                   std::vector<TexelMeaning> meanings, std::span<const VertexField> field)
    : model_(model),
      faces_(std::move(faces)),
      meanings_(std::move(meanings)),
      before_{picture_slopes(model, faces_), std::move(images), {}},
      points_(spread_points(model, faces_, field, kPoints)) {}

PictureLosses SeenLoss::of(std::span<const AtlasFace> to, std::span<const std::array<float, 3>> turns,
                           std::span<const Image8> images, const Context& context) const {
  constexpr std::size_t kChunk = 1024;
  const View now = view(to, images);
  std::vector<PictureLosses> sums((points_.size() + kChunk - 1) / kChunk);
  std::vector<double> counts(sums.size());
  parallel_for_or_throw(context, sums.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, points_.size()); ++i) {
        const SurfacePoint& point = points_[i];
        const Vec2f was = single(uv_at(faces_[point.face], point.weights)),
                    is = single(uv_at(to[point.face], point.weights));
        double turn = 0;
        for (std::size_t k = 0; k < 3 && !turns.empty(); ++k)
          turn += point.weights[k] * static_cast<double>(turns[point.face][k]);
        sums[chunk].add(at(point.face, was, is, static_cast<float>(turn), now), point.counts);
        counts[chunk] += point.counts;
      }
    }
  });
  PictureLosses sum, mean;
  double count = std::numeric_limits<double>::min();
  for (std::size_t chunk = 0; chunk < sums.size(); ++chunk) {
    sum.add(sums[chunk], 1);
    count += counts[chunk];
  }
  mean.add(sum, 1 / count);
  if (std::ranges::none_of(meanings_,
                           [](const TexelMeaning& m) { return m.kind == TexelMeaning::Kind::color; }))
    mean.color = mean.all;
  return mean;
}

ImageF SeenLoss::map(const TexelOrigins& places, std::span<const Image8> images,
                     const Context& context) const {
  const View now = view(faces_, images);
  ImageF result(places.width, places.height, 1, ColorEncoding::linear);
  parallel_for_or_throw(context, static_cast<std::size_t>(places.height), 8,
                        [&](std::size_t begin, std::size_t end) {
                          for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                            for (int x = 0; x < places.width; ++x) {
                              const std::size_t i = places.index(x, y);
                              if (places.drawn[i] == 0) continue;
                              const Vec2f uv = places.texels[i].uv;
                              double sum = 0;
                              for (const double loss : at(places.texels[i].face, uv, uv, 0, now).all)
                                sum += loss;
                              *result.at(x, y) = static_cast<float>(sum / kPictureSizes.size());
                            }
                          }
                        });
  return result;
}

SeenLoss::View SeenLoss::view(std::span<const AtlasFace> faces, std::span<const Image8> images) const {
  View view{picture_slopes(model_, faces), {}, {}};
  const auto sizes = [&](std::size_t i) {
    const MipMap &was = before_.images[i], &is = view.images[i];
    return std::array{was.width(), was.height(), is.width(), is.height()};
  };
  for (std::size_t i = 0; i < images.size(); ++i) {
    view.images.push_back(images[i].width > 0 ? mip_map(images[i], meanings_[i]) : MipMap());
    if (images[i].width == 0) continue;
    const auto same =
        std::ranges::find_if(view.alike, [&](const auto& a) { return sizes(a[0]) == sizes(i); });
    if (same == view.alike.end()) {
      view.alike.push_back({i});
    } else {
      same->push_back(i);
    }
  }
  return view;
}

PictureLosses SeenLoss::at(std::uint32_t face, Vec2f was, Vec2f is, float turn, const View& now) const {
  PictureLosses result;
  for (std::size_t p = 0; p < kPictureSizes.size(); ++p) {
    const UvSlopes slopes_before = scaled(before_.slopes[face], 1 / kPictureSizes[p]),
                   slopes_now = scaled(now.slopes[face], 1 / kPictureSizes[p]);
    for (const std::vector<std::size_t>& images : now.alike) {
      const Footprint look_before = before_.images[images[0]].footprint(was, slopes_before, sampler_),
                      look_now = now.images[images[0]].footprint(is, slopes_now, sampler_);
      for (const std::size_t k : images) {
        const TexelMeaning& meaning = meanings_[k];
        Rgba before = before_.images[k].sample(look_before);
        if (meaning.kind == TexelMeaning::Kind::normal) before = turned(before, turn, false);
        const double loss =
            squared_difference(shown(before, meaning), shown(now.images[k].sample(look_now), meaning));
        result.all[p] += loss * loss_weight(meaning);
        if (meaning.kind != TexelMeaning::Kind::color) continue;
        result.color[p] += loss;
        result.distance[p] += std::sqrt(loss);
      }
    }
  }
  return result;
}

}  // namespace fovea
