#include "fovea/render/tile.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace fovea {

namespace {

constexpr std::int64_t kOne = 1 << kSubsampleBits, kHalf = kOne / 2;

/// An edge as a function that is not negative inside: a·x + b·y + c over samples. Samples on an edge belong
/// to the triangle if the edge is at its top or left.
struct Edge {
  std::int64_t a, b, c;

  /// The edge from p to q of a clockwise triangle (y down), over the samples of a tile.
  Edge(const ScreenVertex& p, const ScreenVertex& q, std::int64_t origin_x, std::int64_t origin_y) {
    const std::int64_t dx = std::int64_t{q.x} - p.x, dy = std::int64_t{q.y} - p.y;
    const std::int64_t x0 = origin_x * kOne + kHalf - p.x, y0 = origin_y * kOne + kHalf - p.y;
    const bool top_left = dy < 0 || (dy == 0 && dx > 0);
    a = -dy * kOne;
    b = dx * kOne;
    c = dx * y0 - dy * x0 - (top_left ? 0 : 1);
  }
  std::int64_t operator()(int x, int y) const { return a * x + b * y + c; }
};

std::int64_t floor_div(std::int64_t n, std::int64_t d) {  // d > 0
  const std::int64_t q = n / d;
  return q * d > n ? q - 1 : q;
}

/// Cuts [x0, x1) to where an edge function that is `at_0` at 0 and rises by `a` is not negative.
void cut_span(std::int64_t a, std::int64_t at_0, int& x0, int& x1) {
  if (a > 0) {
    x0 = static_cast<int>(std::max<std::int64_t>(x0, -floor_div(at_0, a)));
  } else if (a < 0) {
    x1 = static_cast<int>(std::min<std::int64_t>(x1, floor_div(at_0, -a) + 1));
  } else if (at_0 < 0) {
    x1 = x0;
  }
}

/// Nearness over the samples of a tile.
struct NearnessPlane {
  double at_0, dx, dy;
  float low, high;

  NearnessPlane(const std::array<ScreenVertex, 3>& v, double double_area, std::int64_t origin_x,
                std::int64_t origin_y) {
    const double x1 = v[1].x - v[0].x, y1 = v[1].y - v[0].y, x2 = v[2].x - v[0].x, y2 = v[2].y - v[0].y;
    const double n0 = static_cast<double>(v[0].nearness);
    const double n1 = static_cast<double>(v[1].nearness) - n0, n2 = static_cast<double>(v[2].nearness) - n0;
    const double scale = kOne / double_area;
    dx = (n1 * y2 - n2 * y1) * scale;
    dy = (n2 * x1 - n1 * x2) * scale;
    const double x0 = static_cast<double>(origin_x * kOne + kHalf - v[0].x) / kOne;
    const double y0 = static_cast<double>(origin_y * kOne + kHalf - v[0].y) / kOne;
    at_0 = n0 + dx * x0 + dy * y0;
    std::tie(low, high) = std::minmax({v[0].nearness, v[1].nearness, v[2].nearness});
  }
};

/// Triangles no wider than this are tried sample by sample.
constexpr int kNarrow = 8;

}  // namespace

TileSamples::TileSamples(const SampleGrid& grid, int column, int row) : per_pixel_(grid.per_pixel) {
  const int samples = grid.tile_pixels() * grid.per_pixel;
  origin_x_ = column * samples;
  origin_y_ = row * samples;
  width_ = std::min(samples, grid.width * grid.per_pixel - origin_x_);
  height_ = std::min(samples, grid.height * grid.per_pixel - origin_y_);
  nearness_.fill(-std::numeric_limits<float>::infinity());
  triangle_.fill(kInvalid);
}

template <class F>
void TileSamples::for_spans(const ScreenTriangle& triangle, F&& span) const {
  std::array<ScreenVertex, 3> v = triangle.v;
  std::int64_t area = (std::int64_t{v[1].x} - v[0].x) * (std::int64_t{v[2].y} - v[0].y) -
                      (std::int64_t{v[2].x} - v[0].x) * (std::int64_t{v[1].y} - v[0].y);
  if (area == 0) return;
  if (area < 0) {
    std::swap(v[1], v[2]);
    area = -area;
  }
  const auto [xl, xh] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [yl, yh] = std::minmax({v[0].y, v[1].y, v[2].y});
  const auto first = [](std::int64_t low, int begin) {
    return static_cast<int>(std::max<std::int64_t>((low + kHalf - 1) >> kSubsampleBits, begin) - begin);
  };
  const auto last = [](std::int64_t high, int begin, int count) {
    return static_cast<int>(std::min<std::int64_t>(((high - kHalf) >> kSubsampleBits) - begin, count - 1));
  };
  const int left = first(xl, origin_x_), right = last(xh, origin_x_, width_) + 1;
  const int top = first(yl, origin_y_), bottom = last(yh, origin_y_, height_) + 1;
  if (left >= right || top >= bottom) return;
  const Edge edges[3] = {{v[0], v[1], origin_x_, origin_y_},
                         {v[1], v[2], origin_x_, origin_y_},
                         {v[2], v[0], origin_x_, origin_y_}};
  const NearnessPlane plane(v, static_cast<double>(area), origin_x_, origin_y_);
  for (int y = top; y < bottom; ++y) {
    int x0 = left, x1 = right;
    if (right - left <= kNarrow) {
      const auto inside = [&](int x) { return (edges[0](x, y) | edges[1](x, y) | edges[2](x, y)) >= 0; };
      while (x0 < x1 && !inside(x0)) ++x0;
      while (x1 > x0 && !inside(x1 - 1)) --x1;
    } else {
      for (const Edge& edge : edges) cut_span(edge.a, edge(0, y), x0, x1);
    }
    if (x0 < x1) span(y, x0, x1, plane);
  }
}

void TileSamples::draw(const ScreenTriangle& triangle) {
  for_spans(triangle, [&](int y, int x0, int x1, const NearnessPlane& plane) {
    float* const nearness = nearness_.data() + index(0, y);
    std::uint32_t* const triangles = triangle_.data() + index(0, y);
    const auto row = static_cast<float>(plane.at_0 + plane.dy * y), slope = static_cast<float>(plane.dx);
    for (int x = x0; x < x1; ++x) {
      const float n = std::clamp(row + slope * static_cast<float>(x), plane.low, plane.high);
      const bool nearer = n > nearness[x];
      nearness[x] = nearer ? n : nearness[x];
      triangles[x] = nearer ? triangle.triangle : triangles[x];
    }
  });
}

void TileSamples::draw_where(const ScreenTriangle& triangle,
                             const std::function<bool(double x, double y)>& keep) {
  for_spans(triangle, [&](int y, int x0, int x1, const NearnessPlane& plane) {
    const auto row = static_cast<float>(plane.at_0 + plane.dy * y), slope = static_cast<float>(plane.dx);
    for (int x = x0; x < x1; ++x) {
      const float n = std::clamp(row + slope * static_cast<float>(x), plane.low, plane.high);
      if (!(n > nearness_[index(x, y)])) continue;
      if (!keep((origin_x_ + x + 0.5) / per_pixel_, (origin_y_ + y + 0.5) / per_pixel_)) continue;
      nearness_[index(x, y)] = n;
      triangle_[index(x, y)] = triangle.triangle;
    }
  });
}

void TileSamples::blend(const ScreenTriangle& triangle, std::vector<BlendedSample>& out) const {
  for_spans(triangle, [&](int y, int x0, int x1, const NearnessPlane& plane) {
    const auto row = static_cast<float>(plane.at_0 + plane.dy * y), slope = static_cast<float>(plane.dx);
    for (int x = x0; x < x1; ++x) {
      const float n = std::clamp(row + slope * static_cast<float>(x), plane.low, plane.high);
      if (n > nearness_[index(x, y)])
        out.push_back({static_cast<std::uint32_t>(index(x, y)), n, triangle.triangle});
    }
  });
}

}  // namespace fovea
