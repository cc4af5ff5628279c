#include "fovea/texture/seam_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/surface/half_edges.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/barycentric.h"
#include "fovea/texture/seen_points.h"
#include "fovea/texture/texel_origin.h"
#include "fovea/texture/texel_scan.h"

namespace fovea {

namespace {

/// Points for each texel, along seams and along both axes.
constexpr int kPointsPerTexel = 2;
/// How much a point of a seam counts beside one of the surface.
constexpr double kSeamWeight = 2;
constexpr int kSolverRounds = 8;          // more sharpen what pictures of smaller copies do not show
constexpr int kMostEdgePoints = 1 << 14;  // of a seam's edge
/// Triangles, and edges of seams, that a thread looks at at once.
constexpr std::size_t kFaceGrain = 256;
/// A triangle that is all but a line in the image does not count more than this.
constexpr double kMostDensity = 16;

/// How much of the surface a texel of each triangle is: 1 in the mean.
std::vector<double> surface_densities(const Model& model, std::span<const AtlasFace> faces) {
  std::vector<double> densities = surface_areas(model, faces);
  double area = 0, in_image = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::array<Vec2d, 3>& uv = faces[i].uv;
    const double flat = std::abs(cross(uv[1] - uv[0], uv[2] - uv[0])) / 2;
    area += densities[i];
    in_image += flat;
    densities[i] = flat > 0 ? densities[i] / flat : 0;
  }
  const double mean = in_image > 0 ? area / in_image : 0;
  for (double& density : densities) density = mean > 0 ? std::min(density / mean, kMostDensity) : 0;
  return densities;
}

/// Texels whose values are sought, and what points want of them.
class LeastSquares {
 public:
  explicit LeastSquares(const Image8& image, const Sampler& sampler)
      : image_(image),
        sampler_(sampler),
        number_(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), kInvalid) {}

  using Colors = std::array<double, 3>;

  /// The four texels that a place reads are sought.
  void seek(Vec2d uv) {
    for (const BilinearTap& tap : taps(uv)) {
      std::uint32_t& number = number_[texel(tap)];
      if (number != kInvalid) continue;
      number = static_cast<std::uint32_t>(texels_.size());
      texels_.push_back(texel(tap));
    }
  }

  /// What a place wants.
  struct Point {
    std::array<std::uint32_t, 4> texels{};  ///< Of those that are sought; kInvalid for others.
    std::array<double, 4> weights{};
    double counts = 1;
    Colors rest{};  ///< Wanted, less what is shown.
  };

  /// A place that wants `wanted()`, 0 … 255, if it reads texels that are sought.
  template <class Wanted>
  void point_at(Vec2d uv, double counts, const Wanted& wanted, std::vector<Point>& points) const {
    const auto around = taps(uv);
    const auto number = [&](const BilinearTap& tap) { return number_[texel(tap)]; };
    if (std::ranges::all_of(around, [&](const auto& tap) { return number(tap) == kInvalid; })) return;
    Point point{{}, {}, counts, wanted()};
    for (std::size_t i = 0; i < around.size(); ++i) {
      point.texels[i] = number(around[i]);
      point.weights[i] = around[i].weight;
      for (std::size_t c = 0; c < channels(); ++c)
        point.rest[c] -= around[i].weight * image_.at(around[i].x, around[i].y)[c];
    }
    points.push_back(point);
  }
  void add(std::span<const Point> points) { points_.insert(points_.end(), points.begin(), points.end()); }

  /// What to add to each texel that is sought.
  std::vector<Colors> solved() const {
    std::vector<Colors> change(texels_.size(), Colors{}), rest = change, step, next;
    for (const Point& point : points_) spread(point, point.rest, rest);
    step = rest;
    double left = dot(rest, rest);
    for (int round = 0; round < kSolverRounds && left > 0; ++round) {
      next.assign(texels_.size(), Colors{});
      for (const Point& point : points_) spread(point, gathered(point, step), next);
      const double along = dot(step, next);
      if (!(along > 0)) break;
      const double length = left / along;
      for (std::size_t i = 0; i < change.size(); ++i) {
        for (std::size_t c = 0; c < channels(); ++c) {
          change[i][c] += length * step[i][c];
          rest[i][c] -= length * next[i][c];
        }
      }
      const double before = std::exchange(left, dot(rest, rest));
      for (std::size_t i = 0; i < step.size(); ++i)
        for (std::size_t c = 0; c < channels(); ++c) step[i][c] = rest[i][c] + left / before * step[i][c];
    }
    return change;
  }

  std::span<const std::size_t> texels() const { return texels_; }
  std::size_t channels() const { return static_cast<std::size_t>(image_.color_channels()); }

 private:
  std::array<BilinearTap, 4> taps(Vec2d uv) const {
    return bilinear_taps({uv.x * image_.width, uv.y * image_.height}, image_.width, image_.height, sampler_);
  }
  std::size_t texel(const BilinearTap& tap) const {
    return static_cast<std::size_t>(tap.y) * static_cast<std::size_t>(image_.width) +
           static_cast<std::size_t>(tap.x);
  }

  Colors gathered(const Point& point, std::span<const Colors> values) const {
    Colors sum{};
    for (std::size_t i = 0; i < point.texels.size(); ++i) {
      if (point.texels[i] == kInvalid) continue;
      for (std::size_t c = 0; c < channels(); ++c) sum[c] += point.weights[i] * values[point.texels[i]][c];
    }
    return sum;
  }
  void spread(const Point& point, const Colors& value, std::span<Colors> sums) const {
    for (std::size_t i = 0; i < point.texels.size(); ++i) {
      if (point.texels[i] == kInvalid) continue;
      for (std::size_t c = 0; c < channels(); ++c)
        sums[point.texels[i]][c] += point.counts * point.weights[i] * value[c];
    }
  }
  static double dot(std::span<const Colors> a, std::span<const Colors> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += std::inner_product(a[i].begin(), a[i].end(), b[i].begin(), 0.0);
    return sum;
  }

  const Image8& image_;
  Sampler sampler_;
  std::vector<std::uint32_t> number_;  // [height × width] in `texels_`, or kInvalid
  std::vector<std::size_t> texels_;
  std::vector<Point> points_;
};

/// Calls f(weight of the second corner) at points along an edge.
template <class F>
void along_edge(const Image8& image, const AtlasFace& face, std::uint32_t corner, F&& f) {
  const Vec2d side = face.uv[(corner + 1) % 3] - face.uv[corner];
  const double texels = std::hypot(side.x * image.width, side.y * image.height);
  const int count = std::clamp(static_cast<int>(std::ceil(kPointsPerTexel * texels)), 1, kMostEdgePoints);
  for (int i = 0; i < count; ++i) f((i + 0.5) / count);
}

Vec2d on_edge(const AtlasFace& face, std::uint32_t corner, double t) {
  return face.uv[corner] * (1 - t) + face.uv[(corner + 1) % 3] * t;
}

}  // namespace

std::vector<SeamEdge> seam_edges(const Model& model, std::span<const AtlasFace> faces) {
  std::vector<std::vector<std::uint32_t>> number(model.meshes.size());
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    std::vector<std::uint32_t>& of = number[faces[i].mesh];
    if (of.empty()) of.assign(model.meshes[faces[i].mesh].surface.face_count(), kInvalid);
    of[faces[i].face] = i;
  }
  std::vector<SeamEdge> seams;
  for (std::size_t m = 0; m < number.size(); ++m) {
    if (number[m].empty()) continue;
    const std::vector<HalfEdge> sorted = sorted_half_edges(model.meshes[m].surface.triangles);
    for_each_edge(sorted, [&](std::span<const HalfEdge> edge) {
      if (edge.size() != 2) return;
      const auto face = [&](const HalfEdge& half) { return number[m][half.triangle()]; };
      if (face(edge[0]) == kInvalid || face(edge[1]) == kInvalid) return;
      const auto ends = [&](const HalfEdge& half) {
        const std::array<Vec2d, 3>& uv = faces[face(half)].uv;
        return std::array{uv[half.low_corner() % 3], uv[half.high_corner() % 3]};
      };
      if (ends(edge[0]) == ends(edge[1])) return;
      for (const HalfEdge& half : edge) seams.push_back({face(half), half.corner % 3});
    });
  }
  return seams;
}

SeamFit::SeamFit(const Model& model, std::span<const AtlasFace> from, std::span<const AtlasFace> to)
    : from_(from),
      to_(to),
      seams_(seam_edges(model, from)),
      slopes_(texel_slopes(to, from, 1, 1)),
      densities_(surface_densities(model, to)) {}

void SeamFit::fit(Image8& image, const MipMap& whole, Wrap wrap_u, Wrap wrap_v,
                  const Context& context) const {
  if (seams_.empty()) return;
  const Sampler sampler{.wrap_u = wrap_u, .wrap_v = wrap_v, .mag_filter = {}, .min_filter = {}, .json = {}};
  const Vec2d points{static_cast<double>(kPointsPerTexel) * image.width,
                     static_cast<double>(kPointsPerTexel) * image.height};
  const auto shown = [&](Vec2d uv, std::uint32_t face) {
    const UvSlopes slopes{slopes_[face].dx * static_cast<float>(1 / points.x),
                          slopes_[face].dy * static_cast<float>(1 / points.y)};
    const Rgba look = whole.sample(single(uv), slopes, sampler, kBakeAnisotropy);
    const auto value = [](float light) { return static_cast<double>(to_display(light)); };
    return LeastSquares::Colors{value(look.r), value(look.g), value(look.b)};
  };
  LeastSquares texels(image, sampler);
  for (const SeamEdge& seam : seams_) {
    const AtlasFace& face = to_[seam.face];
    along_edge(image, face, seam.corner, [&](double t) { texels.seek(on_edge(face, seam.corner, t)); });
  }
  using Points = std::vector<LeastSquares::Point>;
  const auto add_along = [&](const SeamEdge& seam, Points& found) {
    const AtlasFace& face = to_[seam.face];
    // As long as it is on the surface.
    const double weight = kSeamWeight * std::sqrt(densities_[seam.face]);
    along_edge(image, face, seam.corner, [&](double t) {
      texels.point_at(
          on_edge(face, seam.corner, t), weight,
          [&] { return shown(on_edge(from_[seam.face], seam.corner, t), seam.face); }, found);
    });
  };
  const auto add_inside = [&](std::uint32_t f, Points& found) {
    std::array<Vec2d, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = {to_[f].uv[k].x * points.x, to_[f].uv[k].y * points.y};
    const Barycentric barycentric(triangle);
    for_texel_rows(triangle, 1, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
      for (std::int64_t x = begin; x < end; ++x) {
        const Vec2d center{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
        texels.point_at(
            {center.x / points.x, center.y / points.y}, densities_[f],
            [&] { return shown(uv_at(from_[f], clamped(barycentric.at(center))), f); }, found);
      }
    });
  };
  const auto add_all = [&](std::size_t count, const auto& add_one) {
    std::vector<Points> found((count + kFaceGrain - 1) / kFaceGrain);
    parallel_for_or_throw(context, count, kFaceGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) add_one(i, found[begin / kFaceGrain]);
    });
    for (const Points& some : found) texels.add(some);
  };
  add_all(seams_.size(), [&](std::size_t i, Points& found) { add_along(seams_[i], found); });
  add_all(to_.size(),
          [&](std::size_t i, Points& found) { add_inside(static_cast<std::uint32_t>(i), found); });
  const std::vector<LeastSquares::Colors> change = texels.solved();
  const auto stride = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < change.size(); ++i) {
    for (std::size_t c = 0; c < texels.channels(); ++c) {
      std::uint8_t& value = image.pixels[texels.texels()[i] * stride + c];
      value = static_cast<std::uint8_t>(std::clamp(value + change[i][c], 0.0, 255.0) + 0.5);
    }
  }
}

}  // namespace fovea
