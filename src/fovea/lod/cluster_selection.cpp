#include "fovea/lod/cluster_selection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "fovea/base/error.h"

namespace fovea {

namespace {

constexpr double kShare = 0.02;          // λ_perc
constexpr double kLeastDistance = 0.01;  // of a cluster's radius

/// What of a cluster's area the eye may see.
double facing(const ClusterProperties& cluster, const View& view) {
  const Vec3d to_eye = view.perspective ? view.eye - cluster.sphere.center : view.back;
  const double away = length(to_eye);
  if (!(away > 0)) return 1;
  const double cosine = std::clamp(dot(to_eye, cluster.mean_normal) / away, -1.0, 1.0);
  const double beyond = std::acos(cosine) - cluster.peak_deviation;
  return beyond <= 0 ? 1 : std::max(0.0, std::cos(beyond));
}

double distance_to(const ClusterProperties& cluster, const View& view) {
  if (!view.perspective) return 1;
  const double r = cluster.sphere.radius;
  return std::max(length(view.eye - cluster.sphere.center) - r, std::max(kLeastDistance * r, 1e-30));
}

}  // namespace

OptionList describe(ClusterSelectionOptions& o) {
  return {{"matching",
           "Where a cluster goes on to coarser levels than one beside it: hold it back at their border, or "
           "let the "
           "other go on too, as published.",
           choice(o.matching, {"hold", "raise"}), ""}};
}

ClusterSelection::ClusterSelection(const SceneSurface& scene, const MultiTessellation& levels,
                                   const Clusters& clusters, std::vector<ClusterProperties> properties,
                                   const ClusterSelectionOptions& options)
    : levels_(levels),
      properties_(std::move(properties)),
      matching_(options.matching),
      steps_(clusters.count),
      neighbors_(clusters.count),
      taken_(levels.step_count()),
      importance_(clusters.count),
      order_(clusters.count),
      dealt_(clusters.count),
      stop_(clusters.count),
      matched_(clusters.count) {
  if (scene.first_vertex != levels.first_vertex ||
      clusters.of_face.size() != scene.surface.triangles.size() || properties_.size() != clusters.count)
    throw Error(ErrorKind::usage, "clusters and levels are of different models", "clusters");
  assign_steps(scene, clusters);
  find_neighbors();
}

/// A step happens in the clusters around the vertex that goes.
void ClusterSelection::assign_steps(const SceneSurface& scene, const Clusters& clusters) {
  std::vector<std::vector<std::uint32_t>> at_vertex(scene.surface.positions.size());
  for (std::size_t f = 0; f < scene.surface.triangles.size(); ++f) {
    const std::uint32_t c = clusters.of_face[FaceId{f}];
    for (const std::uint32_t v : scene.surface.triangles[f]) {
      if (std::ranges::find(at_vertex[v], c) == at_vertex[v].end()) at_vertex[v].push_back(c);
    }
  }
  for (std::uint32_t s = 0; s < levels_.step_count(); ++s) {
    const CollapseStep& step = levels_.record.steps[s];
    const std::span<const std::uint32_t> corners = levels_.corners_of(s);
    const std::uint32_t v = step.kind == StepKind::collapse ? levels_.vertex(step.mesh, step.removed)
                            : corners.empty()               ? kInvalid
                                                            : corners.front();
    if (v != kInvalid) clusters_.insert(clusters_.end(), at_vertex[v].begin(), at_vertex[v].end());
    clusters_end_.push_back(static_cast<std::uint32_t>(clusters_.size()));
    if (!clusters_of(s).empty()) steps_[clusters_of(s).front()].push_back(s);
  }
}

void ClusterSelection::find_neighbors() {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Need>> needs;
  for (std::uint32_t s = 0; s < levels_.step_count(); ++s) {
    if (clusters_of(s).empty()) continue;
    const std::uint32_t own = clusters_of(s).front();
    for (const std::uint32_t needed : levels_.needs_of(s)) {
      if (clusters_of(needed).empty() || clusters_of(needed).front() == own) continue;
      std::vector<Need>& list = needs[{own, clusters_of(needed).front()}];
      if (list.empty() || list.back().stop < needed + 1) list.push_back({s, needed + 1});
    }
  }
  for (auto& [pair, list] : needs) neighbors_[pair.first].push_back({pair.second, std::move(list)});
}

void ClusterSelection::begin(const LevelCamera& camera, const LevelBudget& budget) {
  weigh(camera);
  triangles_ = budget.triangles;
  low_ = 0;
  high_ = best_ = levels_.step_count();
  best_left_ = 0;
  done_ = 0;
}

void ClusterSelection::weigh(const LevelCamera& camera) {
  double total = 0;
  for (const ClusterProperties& c : properties_) total += c.total_saliency;
  for (std::size_t c = 0; c < properties_.size(); ++c) {
    const ClusterProperties& p = properties_[c];
    const double area = facing(p, camera.view) * p.area / distance_to(p, camera.view);
    const double worth = total > 0 ? p.total_saliency * p.peak_saliency * p.mean_saliency / total : 1;
    importance_[c] = area * worth;
  }
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(importance_[a], a) < std::pair(importance_[b], b);
  });
}

bool ClusterSelection::advance(std::size_t work) {
  const std::size_t count = levels_.step_count(), total = total_work();
  const std::size_t end = work < total - done_ ? done_ + work : total;
  while (done_ < end) {
    const std::size_t first = done_ % count, rest = done_ - first;
    const std::size_t last = std::min(end - rest, count);
    if (first == 0) begin_try();
    take(first, last);
    done_ = rest + last;
    if (last == count) finish_try();
  }
  return done_ == total;
}

/// Halves what is between too few contractions and enough; at last takes the best of what was tried, as more
/// contractions need not leave fewer triangles.
void ClusterSelection::begin_try() {
  const bool is_last = done_ + levels_.step_count() == total_work();
  tried_ = is_last ? best_ : low_ + (high_ - low_) / 2;
  deal(tried_);
  matched_ = stop_;
  if (matching_ == ClusterMatching::raise) match_neighbors();
  left_ = levels_.triangles;
}

void ClusterSelection::deal(std::uint64_t contractions) {
  std::ranges::fill(dealt_, 0);
  const auto share =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kShare * static_cast<double>(contractions)));
  for (bool going = true; going && contractions > 0;) {
    going = false;
    for (const std::uint32_t c : order_) {
      const std::uint64_t given = std::min({share, contractions, steps_[c].size() - dealt_[c]});
      dealt_[c] += given;
      contractions -= given;
      going = going || given > 0;
    }
  }
  for (std::size_t c = 0; c < stop_.size(); ++c) stop_[c] = dealt_[c] > 0 ? steps_[c][dealt_[c] - 1] + 1 : 0;
}

void ClusterSelection::match_neighbors() {
  for (std::size_t c = 0; c < stop_.size(); ++c) {
    for (const Neighbor& neighbor : neighbors_[c]) {
      const auto end = std::ranges::lower_bound(neighbor.needs, stop_[c], {}, &Need::step);
      if (end == neighbor.needs.begin()) continue;
      std::uint32_t& stop = matched_[neighbor.cluster];
      stop = std::max(stop, std::prev(end)->stop);
    }
  }
}

void ClusterSelection::take(std::size_t begin, std::size_t end) {
  for (std::size_t s = begin; s < end; ++s) {
    const auto goes_on = [&](std::uint32_t c) { return s < matched_[c]; };
    const auto has = [&](std::uint32_t needed) { return taken_.has(needed); };
    const bool takes =
        std::ranges::any_of(clusters_of(s), goes_on) && std::ranges::all_of(levels_.needs_of(s), has);
    taken_.set(s, takes);
    if (takes) left_ -= levels_.removed_by(s);
  }
}

void ClusterSelection::finish_try() {
  const bool is_enough = left_ <= triangles_;
  (is_enough ? high_ : low_) = tried_;
  if (!is_enough || left_ <= best_left_) return;
  best_ = tried_;
  best_left_ = left_;
}

}  // namespace fovea
