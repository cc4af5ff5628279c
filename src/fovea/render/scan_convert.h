#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>

#include "fovea/render/screen_vertex.h"

// Which samples a triangle covers, and what it has there.

namespace fovea {

/// A rectangle of the sample grid.
struct SampleRect {
  int left = 0, top = 0;  ///< First sample in the grid.
  int width = 0, height = 0;
};

/// Samples [left, right) × [top, bottom), counted from the corner of a rectangle.
struct SampleBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return left >= right || top >= bottom; }
};

/// The samples of a rectangle that are within a triangle's extent.
inline SampleBox sample_box(const std::array<ScreenVertex, 3>& v, const SampleRect& rect) {
  const auto [xl, xh] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [yl, yh] = std::minmax({v[0].y, v[1].y, v[2].y});
  constexpr std::int64_t kHalf = kSubsamples / 2;
  const auto first = [](std::int64_t low, int begin) {
    return static_cast<int>(std::max<std::int64_t>((low + kHalf - 1) >> kSubsampleBits, begin) - begin);
  };
  const auto last = [](std::int64_t high, int begin, int count) {
    return static_cast<int>(std::min<std::int64_t>(((high - kHalf) >> kSubsampleBits) - begin, count - 1));
  };
  return {first(xl, rect.left), first(yl, rect.top), last(xh, rect.left, rect.width) + 1,
          last(yh, rect.top, rect.height) + 1};
}

/// Nearness of a triangle over the samples of a rectangle; never beyond that of its corners.
struct NearnessPlane {
  double at_0 = 0, dx = 0, dy = 0;
  float low = 0, high = 0;

  NearnessPlane() = default;  ///< Of nothing.

  /// `v` is clockwise; `double_area` is twice its area in screen units.
  NearnessPlane(const std::array<ScreenVertex, 3>& v, double double_area, const SampleRect& rect) {
    const double x1 = v[1].x - v[0].x, y1 = v[1].y - v[0].y, x2 = v[2].x - v[0].x, y2 = v[2].y - v[0].y;
    const double n0 = static_cast<double>(v[0].nearness);
    const double n1 = static_cast<double>(v[1].nearness) - n0, n2 = static_cast<double>(v[2].nearness) - n0;
    const double scale = kSubsamples / double_area;
    dx = (n1 * y2 - n2 * y1) * scale;
    dy = (n2 * x1 - n1 * x2) * scale;
    const double x0 =
        static_cast<double>(std::int64_t{rect.left} * kSubsamples + kSubsamples / 2 - v[0].x) / kSubsamples;
    const double y0 =
        static_cast<double>(std::int64_t{rect.top} * kSubsamples + kSubsamples / 2 - v[0].y) / kSubsamples;
    at_0 = n0 + dx * x0 + dy * y0;
    std::tie(low, high) = std::minmax({v[0].nearness, v[1].nearness, v[2].nearness});
  }

  /// Calls f(x, nearness) for the samples [x0, x1) of a row.
  template <class F>
  void for_row(int y, int x0, int x1, F&& f) const {
    const auto row = static_cast<float>(at_0 + dy * y), slope = static_cast<float>(dx);
    for (int x = x0; x < x1; ++x) f(x, std::clamp(row + slope * static_cast<float>(x), low, high));
  }
};

namespace scan {

/// An edge as a function that is not negative inside: a·x + b·y + c over samples. Samples on an edge belong
/// to the triangle if the edge is at its top or left.
struct Edge {
  std::int64_t a, b, c;

  /// The edge from p to q of a clockwise triangle (y down), over the samples of a rectangle.
  Edge(const ScreenVertex& p, const ScreenVertex& q, const SampleRect& rect) {
    constexpr std::int64_t kOne = kSubsamples, kHalf = kOne / 2;
    const std::int64_t dx = std::int64_t{q.x} - p.x, dy = std::int64_t{q.y} - p.y;
    const std::int64_t x0 = rect.left * kOne + kHalf - p.x, y0 = rect.top * kOne + kHalf - p.y;
    const bool top_left = dy < 0 || (dy == 0 && dx > 0);
    a = -dy * kOne;
    b = dx * kOne;
    c = dx * y0 - dy * x0 - (top_left ? 0 : 1);
  }
  std::int64_t operator()(int x, int y) const { return a * x + b * y + c; }
};

inline std::int64_t floor_div(std::int64_t n, std::int64_t d) {  // d > 0
  const std::int64_t q = n / d;
  return q * d > n ? q - 1 : q;
}

/// Cuts [x0, x1) to where an edge function that is `at_0` at 0 and rises by `a` is not negative.
inline void cut_span(std::int64_t a, std::int64_t at_0, int& x0, int& x1) {
  if (a > 0) {
    x0 = static_cast<int>(std::max<std::int64_t>(x0, -floor_div(at_0, a)));
  } else if (a < 0) {
    x1 = static_cast<int>(std::min<std::int64_t>(x1, floor_div(at_0, -a) + 1));
  } else if (at_0 < 0) {
    x1 = x0;
  }
}

/// Triangles no wider than this are tried sample by sample.
inline constexpr int kNarrow = 8;

}  // namespace scan

/// Calls span(y, x0, x1, plane) for the samples [x0, x1) of each row of the rectangle that the triangle
/// covers, with its nearness there; counted from the rectangle's own corner. Either winding. Triangles that
/// share an edge cover no sample twice and leave none out between them.
template <class F>
void for_spans(std::array<ScreenVertex, 3> v, const SampleRect& rect, F&& span) {
  std::int64_t area = double_area(v);
  if (area == 0) return;
  if (area < 0) {
    std::swap(v[1], v[2]);
    area = -area;
  }
  const SampleBox box = sample_box(v, rect);
  if (box.empty()) return;
  const scan::Edge edges[3] = {{v[0], v[1], rect}, {v[1], v[2], rect}, {v[2], v[0], rect}};
  const NearnessPlane plane(v, static_cast<double>(area), rect);
  for (int y = box.top; y < box.bottom; ++y) {
    int x0 = box.left, x1 = box.right;
    if (box.right - box.left <= scan::kNarrow) {
      const auto inside = [&](int x) { return (edges[0](x, y) | edges[1](x, y) | edges[2](x, y)) >= 0; };
      while (x0 < x1 && !inside(x0)) ++x0;
      while (x1 > x0 && !inside(x1 - 1)) --x1;
    } else {
      for (const scan::Edge& edge : edges) scan::cut_span(edge.a, edge(0, y), x0, x1);
    }
    if (x0 < x1) span(y, x0, x1, plane);
  }
}

}  // namespace fovea
