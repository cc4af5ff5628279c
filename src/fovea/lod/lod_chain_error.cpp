#include "fovea/lod/lod_chain_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "fovea/base/parallel.h"
#include "fovea/judge/surface_distance.h"
#include "fovea/surface/closest_point.h"
#include "fovea/surface/key_poses.h"

namespace fovea {

namespace {

/// Of the diagonal: below it distances are what rounding positions to floats leaves.
constexpr double kRounding = 2e-7;
/// Between two poses of an animation, in seconds.
constexpr double kStep = 1.0 / 30;
/// Of all animations; more than that are looked at in longer steps.
constexpr std::size_t kMostPoses = 8192;
/// For what is between the poses of an animation.
constexpr double kErrorMargin = 1.01;
/// Of samples that are looked at in every pose, over all poses; vertices are in any case.
constexpr std::size_t kLooks = 20'000'000;
/// Poses in which the error is nearly the largest are measured on all points, ...
constexpr double kNearly = 0.97;
/// ... so many of them.
constexpr std::size_t kMeasuredAfter = 3;
/// Where points are farthest triangles are looked at more closely: so many, along so many lines.
constexpr std::size_t kFarTriangles = 32;
constexpr int kLines = 16;
/// Poses that are looked at before what was found in them helps with others.
constexpr std::size_t kTogether = 64;
constexpr std::size_t kGrain = 1024;

/// The triangles that a model shows, and their points in any pose.
class ShownSurface {
 public:
  explicit ShownSurface(const Model& model) : model_(model) {
    for (const Instance& instance : instances(model, rest_pose(model))) {
      const TriMesh& mesh = model.meshes[instance.mesh].surface;
      const std::vector<CornerId> corners = first_corners(mesh);
      std::vector<std::uint32_t> number(corners.size(), kInvalid);
      std::vector<CornerId>& shown = corners_.emplace_back();
      for (std::size_t v = 0; v < corners.size(); ++v) {
        if (!corners[v].valid()) continue;
        number[v] = point_count_++;
        shown.push_back(corners[v]);
      }
      for (const auto& t : mesh.triangles)
        triangles_.push_back({number[t[0].index()], number[t[1].index()], number[t[2].index()]});
    }
  }

  std::size_t point_count() const { return point_count_; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }

  std::vector<Vec3f> points(const Pose& pose) const {
    std::vector<Vec3f> all;
    all.reserve(point_count_);
    const std::vector<Instance> shown = instances(model_, pose);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const std::vector<Vec3f> points = posed_points(model_, pose, shown[i], corners_[i]);
      all.insert(all.end(), points.begin(), points.end());
    }
    return all;
  }
  Surface surface(const Pose& pose) const { return {points(pose), triangles_}; }

 private:
  const Model& model_;
  std::vector<std::vector<CornerId>> corners_;  // [#instances], one for each of its points
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::uint32_t point_count_ = 0;
};

/// A point of a triangle.
struct Place {
  std::uint32_t triangle = 0;
  float v = 0, w = 0;  ///< Weights of its second and third corner.
};

Vec3f at(const Place& place, const std::vector<std::array<std::uint32_t, 3>>& triangles,
         const std::vector<Vec3f>& points) {
  const auto& [a, b, c] = triangles[place.triangle];
  return points[a] * (1 - place.v - place.w) + points[b] * place.v + points[c] * place.w;
}

Place place_of(std::uint32_t triangle, const std::array<double, 3>& weights) {
  return {triangle, static_cast<float>(weights[1]), static_cast<float>(weights[2])};
}

/// All points that triangles use, then samples by area at rest.
std::vector<Place> places_on(const ShownSurface& shown, std::int64_t samples, std::uint64_t seed,
                             const Surface& at_rest) {
  std::vector<Place> places;
  std::vector<bool> seen(shown.point_count());
  for (std::uint32_t t = 0; t < shown.triangles().size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = shown.triangles()[t][k];
      if (seen[v]) continue;
      seen[v] = true;
      places.push_back({t, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f});
    }
  }
  for (const SurfaceSample& sample : surface_samples(at_rest, samples, seed))
    places.push_back(place_of(sample.triangle, sample.weights));
  return places;
}

/// Places on one surface, and what was nearest to them on the other in the poses that were measured.
struct Way {
  std::vector<Place> from;
  std::vector<std::vector<Place>> to;  ///< [#poses measured][#from]
  std::vector<double> distance;        ///< [#from], in the pose that was measured last.
  std::size_t vertices = 0;            ///< The first of `from`, which count for the largest distance alone.
  // Those of `from` that are looked at in every pose, and what else was nearest to each in some pose.
  std::vector<std::uint32_t> in_motion;
  std::vector<std::vector<Place>> also;  ///< [#in_motion]
};

bool is_finite(const std::vector<Vec3f>& points) {
  return std::ranges::all_of(
      points, [](const Vec3f& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
}

double rounding_of(const std::vector<Vec3f>& points) {
  Box box;
  for (const Vec3f& p : points) box.add(Vec3d(p));
  return kRounding * box.diagonal();
}

}  // namespace

/// What levels are held against.
struct LodReference::Original {
  ShownSurface shown;
  Pose rest;
  std::vector<Pose> key_poses;
  std::vector<PoseSource> motion;
  std::vector<Place> places;
  std::int64_t samples = 0;
};

/// One level against the original.
class LodReference::Level {
 public:
  Level(const Original& original, const Model& level, const Context& context)
      : original_(original), level_(level), context_(context) {
    forward_ = make_way(original.places, original.shown.point_count(), original.motion.size());
    backward_ = make_way(places_on(level_, original.samples, context.seed, level_.surface(original.rest)),
                         level_.point_count(), original.motion.size());
  }

  LodError run() {
    if (is_empty()) return error_;
    measure(original_.rest);
    for (const Pose& pose : original_.key_poses) measure(pose);
    return error();
  }
  /// To be called after `run`. Returns the pose with the largest error; none if that is one that was
  /// measured.
  std::optional<Pose> look_at_motion();
  LodError error() const {
    return {original_.motion.empty() ? error_.max : kErrorMargin * error_.max, error_.mean};
  }

 private:
  /// Whether a surface is; then the error is known.
  bool is_empty() {
    if (!original_.shown.triangles().empty() && !level_.triangles().empty()) return false;
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (original_.shown.triangles().empty() != level_.triangles().empty()) error_ = {kInfinite, kInfinite};
    return true;
  }

  static Way make_way(std::vector<Place> from, std::size_t vertices, std::size_t poses) {
    Way way{std::move(from), {}, {}, vertices, {}, {}};
    const std::size_t samples = way.from.size() - vertices;
    const std::size_t stride = 1 + samples * poses / kLooks;
    for (std::size_t i = 0; i < way.from.size(); i += i < vertices ? 1 : stride)
      way.in_motion.push_back(static_cast<std::uint32_t>(i));
    way.also.resize(way.in_motion.size());
    return way;
  }

  /// Measures all points in a pose, and keeps what is nearest to each.
  /// Returns the largest distance.
  double measure(const Pose& pose) {
    const Surface original{original_.shown.surface(pose)}, level{level_.surface(pose)};
    const ClosestPoint to_original(original), to_level(level);
    const LodError there = measure(forward_, original, to_level),
                   back = measure(backward_, level, to_original);
    if (std::max(there.max, back.max) < rounding_of(original.positions)) return 0;
    of_points_ = std::max({of_points_, there.max, back.max});
    const double largest = std::max({there.max, back.max, look_closer(forward_, original, to_level),
                                     look_closer(backward_, level, to_original)});
    error_.max = std::max(error_.max, largest);
    error_.mean = std::max(error_.mean, 0.5 * (there.mean + back.mean));
    return largest;
  }

  LodError measure(Way& way, const Surface& from, const ClosestPoint& to) {
    std::vector<Place>& places = way.to.emplace_back(way.from.size());
    std::vector<double>& distance = way.distance;
    distance.resize(way.from.size());
    parallel_for_or_throw(context_, way.from.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto hit = to.nearest(Vec3d(at(way.from[i], from.triangles, from.positions)));
        places[i] = place_of(hit.triangle, hit.weights);
        distance[i] = hit.distance;
      }
    });
    LodError found;
    for (const double d : distance) found.max = std::max(found.max, d);
    const auto spread = static_cast<double>(way.from.size() - way.vertices);
    for (std::size_t i = way.vertices; i < distance.size(); ++i) found.mean += distance[i] / spread;
    return found;
  }

  /// The largest distance on the triangles whose points are farthest, as `measure` has just found them.
  double look_closer(const Way& way, const Surface& from, const ClosestPoint& to) const {
    std::vector<std::uint32_t> order(way.from.size());
    std::iota(order.begin(), order.end(), 0u);
    const std::size_t count = std::min(order.size(), 4 * kFarTriangles);
    std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(count), std::greater(),
                              [&](std::uint32_t i) { return std::pair(way.distance[i], ~i); });
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i < count && triangles.size() < kFarTriangles; ++i) {
      const std::uint32_t t = way.from[order[i]].triangle;
      if (std::ranges::find(triangles, t) == triangles.end()) triangles.push_back(t);
    }
    std::vector<double> largest(triangles.size());
    parallel_for_or_throw(context_, triangles.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        for (int i = 0; i <= kLines; ++i) {
          for (int j = 0; i + j <= kLines; ++j) {
            const Place place{triangles[t], static_cast<float>(i) / kLines, static_cast<float>(j) / kLines};
            const Vec3f p = at(place, from.triangles, from.positions);
            largest[t] = std::max(largest[t], to.nearest(Vec3d(p)).distance);
          }
        }
      }
    });
    return largest.empty() ? 0 : *std::ranges::max_element(largest);
  }

  /// A point that is farther from all that was nearest to it in other poses than the error so far: in this
  /// one its nearest place, too.
  struct Found {
    std::uint32_t index = 0;  ///< In `in_motion`.
    Place nearest;
  };
  struct Moment {
    double error = 0;
    std::vector<Found> forward, backward;
  };

  /// The largest distance in a pose, if it is more than `enough`. 0 for rounding, and in poses with points
  /// that are not numbers.
  Moment look_at(const Pose& pose, double enough) const {
    const Surface original{original_.shown.surface(pose)}, level{level_.surface(pose)};
    Moment moment;
    if (!is_finite(original.positions) || !is_finite(level.positions)) return moment;
    enough = std::max(enough, rounding_of(original.positions));
    moment.forward = look_at(forward_, original, level, enough, moment.error);
    moment.backward = look_at(backward_, level, original, enough, moment.error);
    return moment;
  }

  static std::vector<Found> look_at(const Way& way, const Surface& from, const Surface& to, double enough,
                                    double& error) {
    std::vector<Found> found;
    const auto near = static_cast<float>(enough * enough);
    const auto is_near = [&](Vec3f p, const Place& place) {
      return length_squared(at(place, to.triangles, to.positions) - p) <= near;
    };
    for (std::uint32_t i = 0; i < way.in_motion.size(); ++i) {
      const std::uint32_t k = way.in_motion[i];
      const Vec3f p = at(way.from[k], from.triangles, from.positions);
      const bool is_known =
          std::ranges::any_of(way.to, [&](const auto& places) { return is_near(p, places[k]); }) ||
          std::ranges::any_of(way.also[i], [&](const Place& place) { return is_near(p, place); });
      if (!is_known) found.push_back({i, {}});
    }
    if (found.empty()) return found;
    const ClosestPoint closest(to);
    for (Found& f : found) {
      const auto hit =
          closest.nearest(Vec3d(at(way.from[way.in_motion[f.index]], from.triangles, from.positions)));
      f.nearest = place_of(hit.triangle, hit.weights);
      error = std::max(error, hit.distance);
    }
    return found;
  }

  const Original& original_;
  const ShownSurface level_;
  const Context& context_;
  Way forward_, backward_;
  LodError error_;
  double of_points_ = 0;  // the largest distance, but for triangles that were looked at more closely
};

std::optional<Pose> LodReference::Level::look_at_motion() {
  const std::vector<PoseSource>& motion = original_.motion;
  if (is_empty()) return {};
  double largest = of_points_;
  std::vector<std::pair<double, std::size_t>> far;  // distances, poses
  for (std::size_t first = 0; first < motion.size(); first += kTogether) {
    std::vector<Moment> moments(std::min(kTogether, motion.size() - first));
    const double enough = kNearly * largest;
    parallel_for_or_throw(context_, moments.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) moments[i] = look_at(motion[first + i].pose(), enough);
    });
    for (std::size_t i = 0; i < moments.size(); ++i) {
      for (const Found& found : moments[i].forward) forward_.also[found.index].push_back(found.nearest);
      for (const Found& found : moments[i].backward) backward_.also[found.index].push_back(found.nearest);
      if (moments[i].error > enough) far.emplace_back(moments[i].error, first + i);
      largest = std::max(largest, moments[i].error);
    }
  }
  const std::size_t count = std::min(far.size(), kMeasuredAfter);
  std::ranges::partial_sort(far, far.begin() + static_cast<std::ptrdiff_t>(count), std::greater());
  std::optional<Pose> worst;
  for (std::size_t i = 0; i < count && far[i].first > kNearly * largest; ++i) {
    const double before = error_.max;
    Pose pose = motion[far[i].second].pose();
    if (measure(pose) > before) worst = std::move(pose);
  }
  return worst;
}

LodReference::LodReference(const Model& model, std::int64_t key_pose_count, std::int64_t samples,
                           const Context& context) {
  auto original =
      std::make_unique<Original>(Original{ShownSurface(model), rest_pose(model), {}, {}, {}, samples});
  if (key_pose_count > 0) {
    KeyPoseOptions options;
    options.count = key_pose_count;
    for (KeyPose& key : key_poses(model, options, context)) {
      if (!(key.pose == original->rest)) original->key_poses.push_back(std::move(key.pose));
    }
    original->motion = motion_poses(model, kStep, kMostPoses);
  }
  original->places =
      places_on(original->shown, samples, context.seed, original->shown.surface(original->rest));
  original_ = std::move(original);
}

LodReference::~LodReference() = default;

LodError LodReference::error(const Model& level, const Context& context) {
  Level measured(*original_, level, context);
  measured.run();
  if (std::optional<Pose> worst = measured.look_at_motion())
    original_->key_poses.push_back(*std::move(worst));
  return measured.error();
}

LodError LodReference::error_in_key_poses(const Model& level, const Context& context) const {
  return Level(*original_, level, context).run();
}

std::size_t LodReference::key_pose_count() const { return original_->key_poses.size(); }

}  // namespace fovea
