#include "fovea/surface/sphere_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "fovea/base/float4.h"
#include "fovea/base/wide.h"

namespace fovea {

namespace {

/// Points sorted into the cells of a regular grid, a few to the largest radius.
class PointGrid {
 public:
  /// Of the vertices that have triangles.
  PointGrid(const Surface& surface, const Adjacency& adjacency, double radius) : surface_(surface) {
    Box box;
    for (const Vec3f& p : surface.positions) box.add(Vec3d(p));
    low_ = box.low;
    // No more cells along an axis than numbers of a cell have room for.
    cell_ = std::max(radius / kCellsPerRadius, box.diagonal() / kMostCells);
    for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
      if (adjacency.corners(v).empty()) continue;
      const Vec3d at = scaled(v);
      entries_.push_back({key(whole(at.x), whole(at.y), whole(at.z)), v});
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// The vertices cell by cell.
  std::vector<std::uint32_t> vertices() const {
    std::vector<std::uint32_t> all;
    for (const Entry& entry : entries_) all.push_back(entry.vertex);
    return all;
  }

  /// Calls f(begin, end) with runs of `vertices` among which are all within the radius, in a fixed order.
  template <class F>
  void for_runs(std::uint32_t v, double radius, F&& f) const {
    const Vec3d at = scaled(v);
    const double reach = cell_ > 0 ? radius / cell_ : 0;
    for (std::int64_t z = first(at.z - reach); z <= whole(at.z + reach); ++z) {
      const double dz = gap(at.z, z);
      for (std::int64_t y = first(at.y - reach); y <= whole(at.y + reach); ++y) {
        const double dy = gap(at.y, y), left2 = reach * reach - dy * dy - dz * dz;
        if (left2 < -kSlack) continue;
        // Cells in a row have numbers in a row.
        const double left = std::sqrt(std::max(left2, 0.0)) + kSlack;
        const auto begin =
            std::lower_bound(entries_.begin(), entries_.end(), key(first(at.x - left), y, z), before);
        const auto end = std::lower_bound(begin, entries_.end(), key(whole(at.x + left), y, z) + 1, before);
        if (begin != end) {
          f(static_cast<std::size_t>(begin - entries_.begin()),
            static_cast<std::size_t>(end - entries_.begin()));
        }
      }
    }
  }

 private:
  static constexpr int kBits = 20;
  static constexpr double kMostCells = (1 << kBits) - 64;
  static constexpr double kCellsPerRadius = 4;
  static constexpr double kSlack = 1e-6;  // of a cell, for rounding
  struct Entry {
    std::uint64_t key;
    std::uint32_t vertex;
    friend bool operator<(const Entry& a, const Entry& b) {
      return a.key != b.key ? a.key < b.key : a.vertex < b.vertex;
    }
  };

  static bool before(const Entry& e, std::uint64_t key) { return e.key < key; }
  /// A vertex in cells from the corner of the box; nothing is below 0.
  Vec3d scaled(std::uint32_t v) const { return cell_ > 0 ? (surface_.position(v) - low_) / cell_ : Vec3d(); }
  static std::int64_t whole(double x) { return static_cast<std::int64_t>(x); }
  static std::int64_t first(double x) { return x > 0 ? whole(x) : 0; }
  /// From x to the cell, 0 inside.
  static double gap(double x, std::int64_t cell) {
    const auto c = static_cast<double>(cell);
    return x < c ? c - x : x > c + 1 ? x - c - 1 : 0;
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(z) << (2 * kBits) | static_cast<std::uint64_t>(y) << kBits |
           static_cast<std::uint64_t>(x);
  }

  const Surface& surface_;
  Vec3d low_;
  double cell_ = 1;
  std::vector<Entry> entries_;
};

/// Four vertices, in whatever registers the machine has.
using Double4 [[gnu::vector_size(32)]] = double;
using Long4 [[gnu::vector_size(32)]] = std::int64_t;

/// Vertices in columns.
struct Columns {
  std::vector<float> x, y, z;
  std::vector<std::vector<float>> numbers;  ///< That are summed.
};
/// A Gaussian that ends.
struct Scale {
  double precision = 0;  ///< 1 / σ²
  double radius2 = 0;
};

/// Inline, as vectors in registers cannot be handed between functions for different machines.
[[gnu::always_inline]] inline void load(Double4& out, const float* from) {
  Float4 four;
  std::memcpy(&four, from, sizeof four);
  out = __builtin_convertvector(four, Double4);
}

/// Adds the numbers of a run of vertices around p to `sums`, [#scales][#numbers][4], of scales that rise.
/// `gaussian` is a polynomial in distance² / σ².
FOVEA_WIDE void add_run(const Columns& columns, std::size_t begin, std::size_t end, Vec3d p,
                        const std::vector<Scale>& scales, const std::vector<double>& gaussian, double* sums) {
  constexpr std::size_t kBlocks = 4;
  std::array<Double4, kBlocks> distance2, weight;
  for (std::size_t i = begin; i < end; i += 4 * kBlocks) {
    const std::size_t blocks = std::min((end - i + 3) / 4, kBlocks);
    Double4 least = Double4{} + std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < blocks; ++b) {
      Double4 dx, dy, dz;
      load(dx, columns.x.data() + i + 4 * b);
      load(dy, columns.y.data() + i + 4 * b);
      load(dz, columns.z.data() + i + 4 * b);
      dx -= p.x;
      dy -= p.y;
      dz -= p.z;
      const Long4 number = Long4{0, 1, 2, 3} + static_cast<std::int64_t>(i + 4 * b);
      const Double4 d2 = dx * dx + dy * dy + dz * dz;
      // What belongs to the next run is infinitely far.
      distance2[b] =
          number < static_cast<std::int64_t>(end) ? d2 : Double4{} + std::numeric_limits<double>::infinity();
      least = distance2[b] < least ? distance2[b] : least;
    }
    const double nearest = std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
    for (std::size_t k = scales.size(); k > 0; --k) {
      const Scale& scale = scales[k - 1];
      if (nearest > scale.radius2) break;  // nor inside the smaller ones
      for (std::size_t b = 0; b < blocks; ++b) {
        const Long4 inside = distance2[b] <= scale.radius2;
        const Double4 t = inside ? distance2[b] * scale.precision : Double4{};
        Double4 value = Double4{} + gaussian[0];
        for (std::size_t c = 1; c < gaussian.size(); ++c) value = value * t + gaussian[c];
        weight[b] = inside ? value : Double4{};
      }
      for (std::size_t n = 0; n < columns.numbers.size(); ++n) {
        double* const at = sums + 4 * ((k - 1) * columns.numbers.size() + n);
        const float* const column = columns.numbers[n].data() + i;
        Double4 sum, numbers;
        std::memcpy(&sum, at, sizeof sum);
        for (std::size_t b = 0; b < blocks; ++b) {
          load(numbers, column + 4 * b);
          sum += weight[b] * numbers;
        }
        std::memcpy(at, &sum, sizeof sum);
      }
    }
  }
}

/// Coefficients, the highest first, of a polynomial for exp(−t / 2) in 0 … `limit`: to 10⁻⁹ up to 16. Through
/// Chebyshev's points, by Newton's divided differences.
std::vector<double> gaussian_polynomial(double limit) {
  const auto count = static_cast<std::size_t>(5 + std::ceil(1.5 * limit));
  std::vector<double> points, differences;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    points.push_back(limit / 2 * (1 + std::cos(angle)));
    differences.push_back(std::exp(-points[i] / 2));
  }
  for (std::size_t order = 1; order < count; ++order) {
    for (std::size_t i = count - 1; i >= order; --i)
      differences[i] = (differences[i] - differences[i - 1]) / (points[i] - points[i - order]);
  }
  std::vector<double> polynomial{differences[count - 1]};
  for (std::size_t i = count - 1; i > 0; --i) {  // times (t − point), plus the next
    polynomial.push_back(0);
    for (std::size_t c = polynomial.size() - 1; c > 0; --c)
      polynomial[c] -= points[i - 1] * polynomial[c - 1];
    polynomial.back() += differences[i - 1];
  }
  return polynomial;
}

}  // namespace

struct SphereSums::Impl {
  const Surface& surface;
  double radius;
  PointGrid grid;
  std::vector<double> gaussian;
  std::vector<Scale> scales = {};  // rising
  Columns columns = {};            // in the order of the grid
};

SphereSums::SphereSums(const Surface& surface, const Adjacency& adjacency,
                       std::span<const std::vector<float>> numbers, std::span<const double> sigmas,
                       double cutoff) {
  const double radius = cutoff * sigmas.back();
  auto impl = std::make_unique<Impl>(
      Impl{surface, radius, PointGrid(surface, adjacency, radius), gaussian_polynomial(cutoff * cutoff)});
  for (const double sigma : sigmas)
    impl->scales.push_back({1 / (sigma * sigma), cutoff * cutoff * sigma * sigma});
  Columns& columns = impl->columns;
  columns.numbers.resize(numbers.size());
  for (const std::uint32_t v : impl->grid.vertices()) {
    columns.x.push_back(surface.positions[v].x);
    columns.y.push_back(surface.positions[v].y);
    columns.z.push_back(surface.positions[v].z);
    for (std::size_t n = 0; n < numbers.size(); ++n) columns.numbers[n].push_back(numbers[n][v]);
  }
  // Whoever loads four may begin at the last.
  const auto pad = [](std::vector<float>& column) { column.resize(column.size() + 3); };
  pad(columns.x);
  pad(columns.y);
  pad(columns.z);
  for (std::vector<float>& column : columns.numbers) pad(column);
  impl_ = std::move(impl);
}

SphereSums::~SphereSums() = default;

void SphereSums::around(std::uint32_t vertex, std::vector<double>& sums) const {
  const std::size_t count = impl_->scales.size() * impl_->columns.numbers.size();
  sums.assign(4 * count, 0);
  impl_->grid.for_runs(vertex, impl_->radius, [&](std::size_t begin, std::size_t end) {
    add_run(impl_->columns, begin, end, impl_->surface.position(vertex), impl_->scales, impl_->gaussian,
            sums.data());
  });
  for (std::size_t i = 0; i < count; ++i)
    sums[i] = (sums[4 * i] + sums[4 * i + 1]) + (sums[4 * i + 2] + sums[4 * i + 3]);
  sums.resize(count);
}

}  // namespace fovea
