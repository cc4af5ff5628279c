#include "fovea/cluster/growth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/cluster/dual_graph.h"
#include "fovea/model/ids.h"

namespace fovea {

namespace {

/// What each factor of a step's cost has at least. As printed they may be 0, and one that is makes whole
/// regions free whatever the others say. Far smaller floors leave nearly all clusters on claws and ear tips
/// and one or two on the body, far larger ones hide saliency. The last factor, between neighbours, shrinks
/// with the size of triangles: its floor is what makes costs add up to about the same on a finer mesh.
constexpr double kFloor = 0.3;

}  // namespace

void GrowingCluster::add(Vec3f normal, float saliency, float area) {
  const double weight = DualGraph::weight(area);
  area_ += weight;
  saliency_sum_ += weight * static_cast<double>(saliency);
  mean_ = static_cast<float>(saliency_sum_ / area_);
  normal_sum_ += weight * Vec3d(normal);
  normal_ = normalized(normal_sum_);
}

double GrowingCluster::step_cost(float from_saliency, float to_saliency, Vec3f to_normal) const {
  const auto apart = [&](float saliency) { return static_cast<double>(std::abs(saliency - to_saliency)); };
  return (kFloor + 1 - dot(normal_, Vec3d(to_normal))) * (kFloor + apart(mean_)) * (kFloor + apart(start_)) *
         (kFloor + apart(from_saliency));
}

Growth::Growth(const ClusterGround& ground)
    : ground_(ground),
      faces_(ground.graph.face_count()),
      of_face_(ground.graph.face_count()),
      visit_(ground.graph.face_count(), 0) {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    faces_[f].normal = ground.graph.normals[f];
    faces_[f].saliency = ground.face_saliency[f];
    faces_[f].area = ground.graph.areas[f];
  }
}

const std::vector<std::uint32_t>& Growth::grow(std::span<const std::uint32_t> seeds) {
  for (Face& face : faces_) {
    face.cost = std::numeric_limits<double>::infinity();
    face.cluster = kInvalid;
  }
  clusters_.clear();
  queue_.clear();
  std::vector<std::uint32_t> first(seeds.size());
  for (std::uint32_t c = 0; c < seeds.size(); ++c) {
    clusters_.emplace_back(ground_.vertex_saliency[seeds[c]]);
    first[c] = first_face(seeds[c]);
    take(first[c], c);
  }
  for (std::uint32_t c = 0; c < seeds.size(); ++c) begin_around(seeds[c], first[c], c);
  while (!queue_.empty()) {
    const auto [cost, step] = queue_.pop();
    if (faces_[step.face].cluster != kInvalid) continue;
    take(step.face, step.cluster);
    queue_around(step.face, step.cluster, cost);
  }
  for (std::size_t f = 0; f < faces_.size(); ++f) of_face_[f] = faces_[f].cluster;
  return of_face_;
}

std::uint32_t Growth::first_face(std::uint32_t seed) {
  const auto corners = ground_.adjacency.corners(seed);
  std::uint32_t best = kInvalid;
  for (const std::uint32_t corner : corners) {
    const std::uint32_t f = corner / 3;
    if (faces_[f].cluster == kInvalid && (best == kInvalid || faces_[f].saliency > faces_[best].saliency))
      best = f;
  }
  return best != kInvalid ? best : nearest_free(corners.front() / 3);
}

/// In links from a triangle; the first found of equals.
std::uint32_t Growth::nearest_free(std::uint32_t face) {
  ++search_;
  wave_ = {face};
  visit_[face] = search_;
  for (std::size_t i = 0;; ++i) {
    if (faces_[wave_[i]].cluster == kInvalid) return wave_[i];
    for (const DualGraph::Link& link : ground_.graph.around(wave_[i])) {
      if (visit_[link.face] == search_) continue;
      visit_[link.face] = search_;
      wave_.push_back(link.face);
    }
  }
}

/// Takes what is free around a seed and linked to the cluster's first triangle, and queues what is around
/// that.
void Growth::begin_around(std::uint32_t seed, std::uint32_t first, std::uint32_t cluster) {
  wave_ = {first};
  for (std::size_t i = 0; i < wave_.size(); ++i) {
    for (const DualGraph::Link& link : ground_.graph.around(wave_[i])) {
      const auto& t = ground_.surface.triangles[link.face];
      if (faces_[link.face].cluster != kInvalid || std::find(t.begin(), t.end(), seed) == t.end()) continue;
      take(link.face, cluster);
      wave_.push_back(link.face);
    }
  }
  for (const std::uint32_t face : wave_) queue_around(face, cluster, 0);
}

void Growth::take(std::uint32_t face, std::uint32_t cluster) {
  Face& f = faces_[face];
  f.cluster = cluster;
  clusters_[cluster].add(f.normal, f.saliency, f.area);
}

void Growth::queue_around(std::uint32_t face, std::uint32_t cluster, double cost) {
  const float saliency = faces_[face].saliency;
  for (const DualGraph::Link& link : ground_.graph.around(face)) {
    Face& to = faces_[link.face];
    if (to.cluster != kInvalid) continue;
    const double step = clusters_[cluster].step_cost(saliency, to.saliency, to.normal);
    const double way = cost + step * static_cast<double>(link.distance);
    if (to.cost <= way) continue;
    to.cost = way;
    queue_.push(way, {link.face, cluster});
  }
}

}  // namespace fovea
