#include "fovea/cluster/kmeans.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/cluster/faces_by_cluster.h"

namespace fovea {

namespace {

constexpr std::size_t kAssignGrain = 4096;
constexpr double kLeastFall = 1e-3;

/// The nearest of several points: looked for outwards from where it would be along one axis.
class NearestPoint {
 public:
  struct Found {
    std::uint32_t point = 0;
    double squared = std::numeric_limits<double>::infinity();
  };

  explicit NearestPoint(const std::vector<Vec3d>& points)
      : axis_(longest_axis(points)), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(along(points[a]), a) < std::pair(along(points[b]), b);
    });
    for (const std::uint32_t i : order_) sorted_.push_back(points[i]);
  }

  /// Of equals the one with the smallest number.
  Found find(Vec3d p) const {
    const auto middle = std::lower_bound(sorted_.begin(), sorted_.end(), along(p),
                                         [&](Vec3d q, double x) { return along(q) < x; });
    Found found;
    for (auto at = middle; at != sorted_.end() && look(at, p, found); ++at) {
    }
    for (auto at = middle; at != sorted_.begin() && look(at - 1, p, found); --at) {
    }
    return found;
  }

 private:
  static int longest_axis(const std::vector<Vec3d>& points) {
    Box box;
    for (const Vec3d& p : points) box.add(p);
    const Vec3d size = box.high - box.low;
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
  }
  double along(Vec3d p) const { return axis_ == 0 ? p.x : axis_ == 1 ? p.y : p.z; }

  /// Whether those beyond can be nearer still.
  bool look(std::vector<Vec3d>::const_iterator at, Vec3d p, Found& found) const {
    const double ahead = along(*at) - along(p);
    if (ahead * ahead > found.squared) return false;
    const std::uint32_t point = order_[static_cast<std::size_t>(at - sorted_.begin())];
    const double squared = length_squared(*at - p);
    if (std::pair(squared, point) < std::pair(found.squared, found.point)) found = {point, squared};
    return true;
  }

  int axis_;
  std::vector<std::uint32_t> order_;
  std::vector<Vec3d> sorted_;
};

class Lloyd {
 public:
  Lloyd(const DualGraph& graph, const std::vector<std::uint32_t>& first_faces, const Context& context)
      : graph_(graph), context_(context), of_face_(graph.face_count()), squared_(graph.face_count()) {
    for (const std::uint32_t f : first_faces) centers_.emplace_back(graph.centers[f]);
  }

  /// Gives each triangle to the nearest centre; returns the sum of squared distances by area.
  double assign() {
    const NearestPoint nearest(centers_);
    std::vector<double> parts(graph_.face_count() / kAssignGrain + 1, 0.0);
    parallel_for(context_, graph_.face_count(), kAssignGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const NearestPoint::Found found = nearest.find(Vec3d(graph_.centers[f]));
        of_face_[f] = found.point;
        squared_[f] = found.squared;
        parts[begin / kAssignGrain] += DualGraph::weight(graph_.areas[f]) * found.squared;
      }
    });
    fill_empty();
    return std::accumulate(parts.begin(), parts.end(), 0.0);
  }

  void move_centers() {
    const FacesByCluster members(of_face_, centers_.size());
    parallel_for(context_, centers_.size(), 1 + centers_.size() / 64,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t c = begin; c < end; ++c) {
                     Vec3d sum;
                     double area = 0;
                     for (const std::uint32_t f : members.of(c)) {
                       sum += DualGraph::weight(graph_.areas[f]) * Vec3d(graph_.centers[f]);
                       area += DualGraph::weight(graph_.areas[f]);
                     }
                     centers_[c] = sum / area;
                   }
                 });
  }

  const std::vector<std::uint32_t>& of_face() const { return of_face_; }
  const std::vector<Vec3d>& centers() const { return centers_; }

 private:
  void fill_empty() {
    std::vector<std::uint32_t> sizes(centers_.size(), 0);
    for (const std::uint32_t c : of_face_) ++sizes[c];
    if (std::find(sizes.begin(), sizes.end(), 0u) == sizes.end()) return;
    std::vector<std::uint32_t> far(graph_.face_count());
    std::iota(far.begin(), far.end(), 0u);
    std::sort(far.begin(), far.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(-squared_[a], a) < std::pair(-squared_[b], b);
    });
    auto next = far.begin();
    for (std::uint32_t c = 0; c < sizes.size(); ++c) {
      if (sizes[c] > 0) continue;
      while (sizes[of_face_[*next]] < 2) ++next;
      --sizes[of_face_[*next]];
      of_face_[*next] = c;
      squared_[*next] = 0;
      centers_[c] = Vec3d(graph_.centers[*next]);
      ++sizes[c];
      ++next;
    }
  }

  const DualGraph& graph_;
  const Context& context_;
  std::vector<Vec3d> centers_;
  std::vector<std::uint32_t> of_face_;  // [#F]
  std::vector<double> squared_;         // [#F], distance to its centre
};

}  // namespace

KMeans k_means(const DualGraph& graph, const std::vector<std::uint32_t>& first_faces,
               std::uint32_t most_rounds, Context& context) {
  Lloyd lloyd(graph, first_faces, context);
  KMeans result;
  for (double last = std::numeric_limits<double>::infinity();;) {
    context.advance_or_throw("cluster", static_cast<double>(result.rounds) / most_rounds);
    const double distortion = lloyd.assign();
    ++result.rounds;
    if (last - distortion <= kLeastFall * distortion) break;
    if (result.rounds == most_rounds) {
      result.end = ClusterEnd::rounds;
      break;
    }
    last = distortion;
    lloyd.move_centers();
  }
  result.of_face = lloyd.of_face();
  result.centers = lloyd.centers();
  return result;
}

std::vector<std::uint32_t> nearest_faces(const DualGraph& graph, const std::vector<std::uint32_t>& of_face,
                                         const std::vector<Vec3d>& centers) {
  std::vector<std::uint32_t> nearest(centers.size());
  std::vector<double> least(centers.size(), std::numeric_limits<double>::infinity());
  for (std::uint32_t f = 0; f < of_face.size(); ++f) {
    const std::uint32_t c = of_face[f];
    const double squared = length_squared(Vec3d(graph.centers[f]) - centers[c]);
    if (squared >= least[c]) continue;
    least[c] = squared;
    nearest[c] = f;
  }
  return nearest;
}

}  // namespace fovea
