#include "fovea/budget/triangle_search.h"

#include <algorithm>
#include <cmath>

namespace fovea {

std::optional<std::uint64_t> most_triangles(
    std::uint64_t bytes, std::uint64_t most,
    const std::function<std::uint64_t(std::uint64_t triangles)>& bytes_at) {
  constexpr int kMostTries = 12;
  constexpr double kNear = 0.01;
  const auto wanted = static_cast<double>(bytes);
  struct Point {
    double triangles = 0, bytes = 0;
  };
  Point high{static_cast<double>(most), static_cast<double>(bytes_at(most))};
  if (high.bytes <= wanted) return most;
  Point low;                  // within the bytes; no triangles before any are known
  Point before, last = high;  // the two that were asked for last
  bool is_known = false;
  for (int i = 0; i < kMostTries && high.triangles - low.triangles > 1; ++i) {
    // Along the straight line, to a little less, so that it is mostly within; halves where that does not do.
    constexpr int kPatience = 6;
    const double slope = (last.bytes - before.bytes) / (last.triangles - before.triangles);
    double tried = last.triangles + ((1 - kNear / 2) * wanted - last.bytes) / slope;
    if (i >= kPatience || !std::isfinite(tried)) tried = (low.triangles + high.triangles) / 2;
    tried = std::clamp(std::floor(tried), low.triangles + 1, high.triangles - 1);
    before = last;
    last = {tried, static_cast<double>(bytes_at(static_cast<std::uint64_t>(tried)))};
    if (last.bytes <= wanted) {
      low = last;
      is_known = true;
      if (wanted - low.bytes <= kNear * wanted) break;
    } else {
      high = last;
    }
  }
  if (!is_known) return std::nullopt;
  return static_cast<std::uint64_t>(low.triangles);
}

}  // namespace fovea
