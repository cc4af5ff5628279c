#include "fovea/sample/paint.h"

#include <algorithm>
#include <cmath>

#include "fovea/base/parallel.h"

namespace fovea::sample {

namespace {

std::uint8_t to_byte(double x) { return static_cast<std::uint8_t>(std::lround(clamp01(x) * 255)); }

/// Distance to the hull of two discs, after the segment between their centres; exact enough where
/// the radii change slowly.
double distance_to(const Taper& stroke, Vec2d p) {
  const Vec2d along = stroke.to - stroke.from, offset = p - stroke.from;
  const double squared = along.x * along.x + along.y * along.y;
  const double t = squared > 0 ? clamp01((offset.x * along.x + offset.y * along.y) / squared) : 0;
  const Vec2d rest = offset - along * t;
  return std::sqrt(rest.x * rest.x + rest.y * rest.y) - mix(stroke.from_radius, stroke.to_radius, t);
}

double smooth_min(double a, double b, double softness) {
  if (softness <= 0) return std::min(a, b);
  const double h = clamp01(0.5 + 0.5 * (b - a) / softness);
  return mix(b, a, h) - softness * h * (1 - h);
}

}  // namespace

void paint(Image8& image, const Chart& chart, double gutter, const Context& context,
           const std::function<Color(double, double)>& color) {
  const auto first = [&](double low) { return std::max(0, static_cast<int>(std::ceil(low - gutter - 0.5))); };
  const auto end = [&](double high, int size) {
    return std::min(size, static_cast<int>(std::floor(high + gutter + 0.5)));
  };
  const int x_first = first(chart.x), x_end = end(chart.x + chart.width, image.width);
  const int y_first = first(chart.y), y_end = end(chart.y + chart.height, image.height);
  if (y_end <= y_first) return;
  const auto rows = static_cast<std::size_t>(y_end - y_first);
  parallel_for(context, rows, 8, [&](std::size_t row_begin, std::size_t row_end) {
    for (int y = y_first + static_cast<int>(row_begin); y < y_first + static_cast<int>(row_end); ++y) {
      const double t = 1 - (y + 0.5 - chart.y) / chart.height;
      for (int x = x_first; x < x_end; ++x) {
        const Color c = color((x + 0.5 - chart.x) / chart.width, t);
        std::uint8_t* pixel = image.at(x, y);
        pixel[0] = to_byte(c.x);
        pixel[1] = to_byte(c.y);
        pixel[2] = to_byte(c.z);
      }
    }
  });
}

double Figure::distance(Vec2d p) const {
  double d = 1e9;
  for (const Taper& stroke : strokes) d = smooth_min(d, distance_to(stroke, p), softness);
  return d;
}

void add_line(Figure& figure, const std::vector<Knot>& knots) {
  for (std::size_t i = 1; i < knots.size(); ++i) {
    figure.strokes.push_back({knots[i - 1].point, knots[i - 1].radius, knots[i].point, knots[i].radius});
  }
}

}  // namespace fovea::sample
