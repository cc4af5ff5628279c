#include "fovea/texture/seen_loss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/tangent_frame.h"
#include "fovea/texture/texel_loss.h"

namespace fovea {

namespace {

/// How long the model is in the pictures, in pixels.
constexpr std::array<double, kPictureSizes> kPixels{512, 1024, 2048};
/// Of the angle between a surface and who looks: that of a sphere, by what of it shows.
constexpr double kMeanCosine = 2.0 / 3;
/// Points on the surface, and how they go on inside triangles: as the sequence R2, by the powers of 1/g, g
/// the plastic number.
constexpr std::size_t kPoints = std::size_t{1} << 16;
constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
/// Half a step of a byte.
constexpr double kLeastDistance = 0.5 / 255, kLeastLoss = kLeastDistance * kLeastDistance;

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

/// How coordinates change along two directions on the surface, square to each other, by a unit of length in
/// the scene where a mesh is shown largest: of [#faces], 0 where a triangle has no area.
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
      before_{surface_slopes(model, faces_), std::move(images)} {
  const Box box = bounds(model);
  diagonal_ = length(Vec3d(box.high) - Vec3d(box.low));
  spread_points(field);
}

void SeenLoss::spread_points(std::span<const VertexField> field) {
  const std::vector<double> scales = largest_scales(model_);
  std::vector<double> ends;  // of the areas, added up
  double area = 0;
  for (const AtlasFace& face : faces_) {
    const TriMesh& mesh = model_.meshes[face.mesh].surface;
    const auto at = [&](std::size_t k) {
      return Vec3d(mesh.positions[mesh.triangles[face.face][k].index()]);
    };
    area += triangle_area(at(0), at(1), at(2)) * scales[face.mesh] * scales[face.mesh];
    ends.push_back(area);
  }
  if (!(area > 0)) return;
  std::uint32_t face = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double along = area * (static_cast<double>(i) + 0.5) / kPoints;
    while (face + std::size_t{1} < ends.size() && ends[face] < along) ++face;
    // Evenly over a triangle, wherever in it the sum of areas ends.
    const double root = std::sqrt(std::fmod(0.5 + static_cast<double>(i) * kStepX, 1.0)),
                 across = std::fmod(0.5 + static_cast<double>(i) * kStepY, 1.0);
    Point point{face, {1 - root, root * (1 - across), root * across}, 1};
    if (!field.empty()) {
      const auto& triangle = model_.meshes[faces_[face].mesh].surface.triangles[faces_[face].face];
      point.counts = 0;
      for (std::size_t k = 0; k < 3; ++k)
        point.counts += point.weights[k] * static_cast<double>(field[faces_[face].mesh][triangle[k]]);
    }
    points_.push_back(point);
  }
}

PictureLosses SeenLoss::of(std::span<const AtlasFace> to, std::span<const std::array<float, 3>> turns,
                           std::span<const Image8> images, const Context& context) const {
  constexpr std::size_t kChunk = 1024;
  const View now = view(to, images);
  std::vector<PictureLosses> sums((points_.size() + kChunk - 1) / kChunk);
  std::vector<double> counts(sums.size());
  parallel_for_or_throw(context, sums.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, points_.size()); ++i) {
        const Point& point = points_[i];
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
                              *result.at(x, y) = static_cast<float>(sum / kPixels.size());
                            }
                          }
                        });
  return result;
}

SeenLoss::View SeenLoss::view(std::span<const AtlasFace> faces, std::span<const Image8> images) const {
  View view{surface_slopes(model_, faces), {}};
  for (std::size_t i = 0; i < images.size(); ++i) view.images.push_back(mip_map(images[i], meanings_[i]));
  return view;
}

PictureLosses SeenLoss::at(std::uint32_t face, Vec2f was, Vec2f is, float turn, const View& now) const {
  PictureLosses result;
  for (std::size_t p = 0; p < kPixels.size(); ++p) {
    const double pixel = diagonal_ / (kPixels[p] * kMeanCosine);
    const UvSlopes slopes_before = scaled(before_.slopes[face], pixel),
                   slopes_now = scaled(now.slopes[face], pixel);
    for (std::size_t k = 0; k < now.images.size(); ++k) {
      const TexelMeaning& meaning = meanings_[k];
      Rgba before = before_.images[k].sample(was, slopes_before, sampler_);
      if (meaning.kind == TexelMeaning::Kind::normal) before = turned(before, turn, false);
      const double loss = squared_difference(before, now.images[k].sample(is, slopes_now, sampler_), meaning);
      result.all[p] += loss * static_cast<double>(loss_weight(meaning));
      if (meaning.kind != TexelMeaning::Kind::color) continue;
      result.color[p] += loss;
      result.distance[p] += std::sqrt(loss);
    }
  }
  return result;
}

}  // namespace fovea
