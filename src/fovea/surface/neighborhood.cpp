#include "fovea/surface/neighborhood.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/surface/diffusion.h"
#include "fovea/surface/geodesic.h"

namespace fovea {

namespace {

/// Vertices whose neighbourhoods one thread finds together: each search has arrays of the size of the mesh.
constexpr std::size_t kGrain = 1 << 12;

/// Sorted into cells of a regular grid as wide as the largest radius, so that neighbours are in 27 cells.
class PointGrid {
 public:
  /// Of the vertices that have triangles.
  PointGrid(const Surface& surface, const Adjacency& adjacency, double radius) : surface_(surface) {
    Box box;
    for (const Vec3f& p : surface.positions) box.add(Vec3d(p));
    low_ = box.low;
    // No more cells along an axis than numbers of a cell have room for.
    cell_ = std::max(radius, box.diagonal() / kMostCells);
    for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
      if (!adjacency.corners(v).empty()) entries_.push_back({key(cell(v)), v});
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls f(vertex, squared distance) for those within the radius, in a fixed order.
  template <class F>
  void for_near(std::uint32_t v, double radius, F&& f) const {
    const std::array<std::int64_t, 3> at = cell(v);
    const Vec3d p = surface_.position(v);
    for (std::int64_t z = at[2] - 1; z <= at[2] + 1; ++z) {
      for (std::int64_t y = at[1] - 1; y <= at[1] + 1; ++y) {
        // Three cells in a row have numbers in a row.
        const std::uint64_t first = key({at[0] - 1, y, z});
        auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{first, 0});
        for (; entry != entries_.end() && entry->key <= first + 2; ++entry) {
          const double d2 = length_squared(surface_.position(entry->vertex) - p);
          if (d2 <= radius * radius) f(entry->vertex, d2);
        }
      }
    }
  }

 private:
  static constexpr int kBits = 20;
  static constexpr double kMostCells = (1 << kBits) - 4;
  struct Entry {
    std::uint64_t key;
    std::uint32_t vertex;
    friend bool operator<(const Entry& a, const Entry& b) {
      return a.key != b.key ? a.key < b.key : a.vertex < b.vertex;
    }
  };

  std::array<std::int64_t, 3> cell(std::uint32_t v) const {
    const Vec3d p = cell_ > 0 ? (surface_.position(v) - low_) / cell_ : Vec3d();
    // One more, so that there are neighbours on all sides.
    return {1 + static_cast<std::int64_t>(p.x), 1 + static_cast<std::int64_t>(p.y),
            1 + static_cast<std::int64_t>(p.z)};
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& c) {
    return static_cast<std::uint64_t>(c[2]) << (2 * kBits) | static_cast<std::uint64_t>(c[1]) << kBits |
           static_cast<std::uint64_t>(c[0]);
  }

  const Surface& surface_;
  Vec3d low_;
  double cell_ = 1;
  std::vector<Entry> entries_;
};

/// The averages at one vertex, of neighbours that come one by one.
class Averager {
 public:
  Averager(std::span<const double> sigmas, double cutoff) {
    for (const double sigma : sigmas) scales_.push_back({-0.5 / (sigma * sigma), cutoff * sigma, 0, 0});
  }
  void start() {
    for (Scale& s : scales_) s.sum = s.weight = 0;
  }
  void add(double distance, double value) {
    for (std::size_t i = scales_.size(); i > 0; --i) {
      Scale& s = scales_[i - 1];
      if (distance > s.radius) return;  // nor within the smaller ones
      const double weight = std::exp(s.exponent * distance * distance);
      s.sum += weight * value;
      s.weight += weight;
    }
  }
  double average(std::size_t scale) const { return scales_[scale].sum / scales_[scale].weight; }

 private:
  struct Scale {
    double exponent, radius, sum, weight;
  };
  std::vector<Scale> scales_;
};

/// Part of σ² that a Gaussian over a surface keeps as its variance when it is cut off at c σ.
double kept_variance(double c) {
  const double edge = std::exp(-c * c / 2);
  return 1 - c * c / 2 * edge / (1 - edge);
}

std::vector<VertexField> diffused(const Surface& surface, const Adjacency& adjacency,
                                  const VertexField& field, std::span<const double> sigmas, double cutoff,
                                  const Context& context) {
  std::vector<double> times;
  for (const double sigma : sigmas) times.push_back(kept_variance(cutoff) * sigma * sigma / 2);
  return HeatFlow(surface, adjacency, context).run(field, times, context);
}

}  // namespace

std::vector<VertexField> gaussian_averages(const Surface& surface, const Adjacency& adjacency,
                                           const VertexField& field, std::span<const double> sigmas,
                                           double cutoff, DistanceKind kind, const Context& context) {
  const bool rising = std::is_sorted(sigmas.begin(), sigmas.end());
  if (sigmas.empty() || !rising || !(sigmas.front() > 0) || !(cutoff > 0))
    throw Error(ErrorKind::usage, "widths of averages must rise from above 0");
  if (kind == DistanceKind::diffusion) return diffused(surface, adjacency, field, sigmas, cutoff, context);
  const double radius = cutoff * sigmas.back();
  const std::span<const float> values = field.values();
  std::vector<VertexField> results(sigmas.size(), VertexField(values.size()));
  if (values.empty()) return results;
  const auto value = [&](std::uint32_t v) { return static_cast<double>(values[v]); };
  const auto run = [&](auto&& make_search) {
    parallel_for(context, values.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      auto search = make_search();
      Averager averager(sigmas, cutoff);
      for (std::size_t v = begin; v < end; ++v) {
        const auto vertex = static_cast<std::uint32_t>(v);
        const bool alone = adjacency.corners(vertex).empty();
        averager.start();
        if (!alone) search(vertex, averager);
        for (std::size_t i = 0; i < results.size(); ++i)
          results[i].values()[v] = alone ? values[v] : static_cast<float>(averager.average(i));
      }
    });
  };
  if (kind == DistanceKind::euclidean) {
    const PointGrid grid(surface, adjacency, radius);
    run([&] {
      return [&](std::uint32_t v, Averager& averager) {
        grid.for_near(v, radius, [&](std::uint32_t w, double d2) { averager.add(std::sqrt(d2), value(w)); });
      };
    });
  } else {
    const GeodesicSurface prepared(surface, adjacency, context);
    run([&] {
      return [&, search = GeodesicSearch(prepared)](std::uint32_t v, Averager& averager) mutable {
        for (const auto& [w, distance] : search.from(v, radius)) averager.add(distance, value(w));
      };
    });
  }
  return results;
}

}  // namespace fovea
