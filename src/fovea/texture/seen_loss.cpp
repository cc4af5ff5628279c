#include "fovea/texture/seen_loss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/texture/texel_loss.h"

namespace fovea {

namespace {

/// How long the model is in the pictures, in pixels.
constexpr std::array<double, 3> kPixels{512, 1024, 2048};
/// Of rows and columns one in so many is looked at.
constexpr int kStride = 2;
/// Half a step of a byte, squared.
constexpr double kLeastLoss = 0.25 / (255.0 * 255.0);
constexpr Sampler kSampler{
    .wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp, .mag_filter = {}, .min_filter = {}, .json = {}};

ColorEncoding encoding_of(const TexelMeaning& meaning) {
  return meaning.kind == TexelMeaning::Kind::color ? ColorEncoding::srgb : ColorEncoding::linear;
}

UvSlopes scaled(const UvSlopes& slopes, double factor) {
  const auto f = static_cast<float>(factor);
  return {slopes.dx * f, slopes.dy * f};
}

Vec2f single(Vec2d a) { return {static_cast<float>(a.x), static_cast<float>(a.y)}; }

/// Of what is shown for two values.
double squared_difference(const Rgba& was, const Rgba& is, const TexelMeaning& meaning) {
  const auto shown = [&](float value) {
    return meaning.kind == TexelMeaning::Kind::color ? static_cast<float>(to_display(value)) / 255 : value;
  };
  const float r = shown(was.r) - shown(is.r), g = shown(was.g) - shown(is.g), b = shown(was.b) - shown(is.b),
              a = meaning.transparent ? was.a - is.a : 0;
  return static_cast<double>(r * r + g * g + b * b + a * a);
}

/// Calls `visit(y)` for one in `stride` rows, on all threads.
template <class Visit>
void for_rows(int height, int stride, const Context& context, const Visit& visit) {
  const auto count = static_cast<std::size_t>((height + stride - 1) / stride);
  parallel_for_or_throw(context, count, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) visit(static_cast<int>(row) * stride);
  });
}

}  // namespace

std::vector<UvSlopes> surface_slopes(const Model& model, std::span<const AtlasFace> faces) {
  const std::vector<double> scales = largest_scales(model);
  std::vector<UvSlopes> result(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const AtlasFace& face = faces[i];
    const TriMesh& mesh = model.meshes[face.mesh].surface;
    const auto at = [&](std::size_t k) {
      return Vec3d(mesh.positions[mesh.triangles[face.face][k].index()]) * scales[face.mesh];
    };
    // The first side lies along x, so the second is (along, up).
    const Vec3d first = at(1) - at(0), second = at(2) - at(0);
    const double side = length(first), area = length(cross(first, second));
    if (!(area > 0)) continue;
    const double along = dot(first, second) / side, up = area / side;
    const Vec2d x = (face.uv[1] - face.uv[0]) * (1 / side),
                y = (face.uv[2] - face.uv[0] - x * along) * (1 / up);
    result[i] = {single(x), single(y)};
  }
  return result;
}

void PictureLosses::add(const PictureLosses& other, double weight) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] += weight * other.all[i];
    color[i] += weight * other.color[i];
  }
}

double PictureLosses::mean() const {
  double product = 1;
  for (std::size_t i = 0; i < all.size(); ++i)
    product *= std::max(all[i], kLeastLoss) * std::max(color[i], kLeastLoss);
  return std::pow(product, 0.5 / static_cast<double>(all.size()));
}

bool PictureLosses::is_worse_somewhere(const PictureLosses& than) const {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] > std::max(than.all[i], kLeastLoss) || color[i] > std::max(than.color[i], kLeastLoss))
      return true;
  }
  return false;
}

SeenLoss::SeenLoss(const Model& model, std::span<const AtlasFace> faces,
                   std::span<const Image8* const> images, std::span<const TexelMeaning> meanings,
                   const ImageF& weights)
    : model_(model), meanings_(meanings), weights_(weights), before_{surface_slopes(model, faces), {}} {
  const Box box = bounds(model);
  diagonal_ = length(Vec3d(box.high) - Vec3d(box.low));
  for (std::size_t i = 0; i < images.size(); ++i)
    before_.images.emplace_back(*images[i], encoding_of(meanings[i]));
}

PictureLosses SeenLoss::of(std::span<const AtlasFace> to, const TexelOrigins& places,
                           std::span<const Image8> images, const Context& context) const {
  const View now = view(to, images);
  std::vector<PictureLosses> rows(static_cast<std::size_t>(places.height));
  std::vector<double> weights(rows.size());
  for_rows(places.height, kStride, context, [&](int y) {
    const auto row = static_cast<std::size_t>(y);
    for (int x = 0; x < places.width; x += kStride) {
      const std::size_t i = places.index(x, y);
      const auto weight = static_cast<double>(weights_.pixels[i]);
      if (places.drawn[i] == 0 || weight == 0) continue;
      rows[row].add(at(x, y, places, now), weight);
      weights[row] += weight;
    }
  });
  PictureLosses sum, mean;
  double weight = std::numeric_limits<double>::min();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    sum.add(rows[row], 1);
    weight += weights[row];
  }
  mean.add(sum, 1 / weight);
  return mean;
}

ImageF SeenLoss::map(std::span<const AtlasFace> to, const TexelOrigins& places,
                     std::span<const Image8> images, const Context& context) const {
  const View now = view(to, images);
  ImageF result(places.width, places.height, 1, ColorEncoding::linear);
  for_rows(places.height, 1, context, [&](int y) {
    for (int x = 0; x < places.width; ++x) {
      if (places.drawn[places.index(x, y)] == 0) continue;
      double sum = 0;
      for (const double loss : at(x, y, places, now).all) sum += loss;
      *result.at(x, y) = static_cast<float>(sum / kPixels.size());
    }
  });
  return result;
}

SeenLoss::View SeenLoss::view(std::span<const AtlasFace> faces, std::span<const Image8> images) const {
  View view{surface_slopes(model_, faces), {}};
  for (std::size_t i = 0; i < images.size(); ++i)
    view.images.emplace_back(images[i], encoding_of(meanings_[i]));
  return view;
}

PictureLosses SeenLoss::at(int x, int y, const TexelOrigins& places, const View& now) const {
  const TexelOrigin& place = places.texels[places.index(x, y)];
  const Vec2f uv{(static_cast<float>(x) + 0.5f) / static_cast<float>(places.width),
                 (static_cast<float>(y) + 0.5f) / static_cast<float>(places.height)};
  PictureLosses result;
  for (std::size_t p = 0; p < kPixels.size(); ++p) {
    const double pixel = diagonal_ / kPixels[p];
    const UvSlopes was = scaled(before_.slopes[place.face], pixel),
                   is = scaled(now.slopes[place.face], pixel);
    for (std::size_t k = 0; k < now.images.size(); ++k) {
      const TexelMeaning& meaning = meanings_[k];
      const double loss = squared_difference(before_.images[k].sample(uv, was, kSampler),
                                             now.images[k].sample(place.uv, is, kSampler), meaning);
      result.all[p] += loss * static_cast<double>(loss_weight(meaning));
      if (meaning.kind == TexelMeaning::Kind::color) result.color[p] += loss;
    }
  }
  return result;
}

}  // namespace fovea
