#include "fovea/texture/texel_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "fovea/base/parallel.h"
#include "fovea/base/wide.h"
#include "fovea/texture/edge_sort.h"
#include "fovea/texture/gaussian_rows.h"

namespace fovea {

namespace {

/// Rows that a thread takes at once; it smooths one more.
constexpr std::size_t kEdgeRowGrain = 16;
/// Weights are below 2⁹: √3 · 255 at most.
constexpr int kWholeBits = 9;
/// More would soon tell weights apart that differ by rounding only.
constexpr int kMostWeightBits = 44;

FOVEA_WIDE void add_squares(const double* a, const double* b, std::size_t count, double* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += (a[i] - b[i]) * (a[i] - b[i]);
}

FOVEA_WIDE void take_roots(std::size_t count, double unit, double* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] = std::sqrt(sum[i]) * unit + 0.5;
}

}  // namespace

/// The weights of the edges of a row's texels, in units.
struct TexelEdges::Row {
  std::size_t width;
  std::vector<double> right, below, below_right, below_left;  // [width]; below_left[x] is from x + 1

  explicit Row(std::size_t size)
      : width(size), right(size), below(size), below_right(size), below_left(size) {}

  /// Distances of two rows, given as planes one after the other.
  void set(std::span<const double> row, std::span<const double> next, double unit) {
    set(right, row, 0, row, 1, unit);
    if (next.empty()) return;
    set(below, row, 0, next, 0, unit);
    set(below_right, row, 0, next, 1, unit);
    set(below_left, row, 1, next, 0, unit);
  }

 private:
  void set(std::vector<double>& out, std::span<const double> a, std::size_t a_first,
           std::span<const double> b, std::size_t b_first, double unit) const {
    const std::size_t count = width - std::max(a_first, b_first);
    std::fill(out.begin(), out.end(), 0.0);
    for (std::size_t plane = 0; plane < a.size(); plane += width)
      add_squares(a.data() + plane + a_first, b.data() + plane + b_first, count, out.data());
    take_roots(count, unit, out.data());
  }
};

TexelEdges::TexelEdges(const Image8& image, double sigma, const Context& context)
    : width_(image.width), height_(image.height) {
  const auto w = static_cast<std::uint32_t>(width_);
  step_ = {1, w, w + 1, w - 1};
  const std::uint64_t numbers = std::uint64_t{4} * w * static_cast<std::uint64_t>(height_);
  number_bits_ = std::max(static_cast<int>(std::bit_width(numbers - 1)), 64 - kMostWeightBits);
  number_mask_ = (std::uint64_t{1} << number_bits_) - 1;
  unit_ = std::ldexp(1.0, 64 - number_bits_ - kWholeBits);

  keys_.resize(first_edge(height_ - 1) + w - 1);
  const GaussianRows rows(image, sigma);
  parallel_for(context, static_cast<std::size_t>(height_), kEdgeRowGrain,
               [&](std::size_t begin, std::size_t end) {
                 GaussianRows::Scratch scratch;
                 std::vector<double> row(rows.planes() * rows.width()), next(row.size());
                 Row weights(rows.width());
                 rows.smooth(static_cast<int>(begin), scratch, next);
                 for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                   row.swap(next);
                   const bool is_last = y + 1 == height_;
                   if (!is_last) rows.smooth(y + 1, scratch, next);
                   weights.set(row, is_last ? std::span<const double>() : next, unit_);
                   add_row(y, weights, keys_.data() + first_edge(y));
                 }
               });
  sort_by_high_bits(keys_, number_bits_, context);
}

/// Texels have four edges each, but for those that the first and the last of a row lack.
std::size_t TexelEdges::first_edge(int y) const {
  return static_cast<std::size_t>(y) * (std::size_t{4} * static_cast<std::size_t>(width_) - 3);
}

void TexelEdges::add_row(int y, const Row& row, std::uint64_t* out) const {
  const bool has_next = y + 1 < height_;
  std::uint64_t number = std::uint64_t{4} * static_cast<std::uint64_t>(y) * row.width;
  const auto add = [&](double units, std::uint64_t direction) {
    *out++ =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(units)) << number_bits_ | (number + direction);
  };
  for (std::size_t x = 0; x < row.width; ++x, number += 4) {
    const bool has_right = x + 1 < row.width;
    if (has_right) add(row.right[x], 0);
    if (!has_next) continue;
    add(row.below[x], 1);
    if (has_right) add(row.below_right[x], 2);
    if (x > 0) add(row.below_left[x - 1], 3);
  }
}

}  // namespace fovea
