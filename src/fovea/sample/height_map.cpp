#include "fovea/sample/height_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/math.h"
#include "fovea/base/random.h"
#include "fovea/sample/noise.h"
#include "fovea/sample/paint.h"

namespace fovea::sample {

namespace {

/// Catmull-Rom weights of four neighbours at `t` between the middle two.
std::array<double, 4> cubic_weights(double t) {
  return {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2 - 1.5 * t)),
          t * t * (-0.5 + 0.5 * t)};
}

/// The four grid points around a place, with their shares.
struct Bilinear {
  int x, y;
  double u, v;
  Bilinear(double px, double py) : x(static_cast<int>(px)), y(static_cast<int>(py)), u(px - x), v(py - y) {}
  double height(const HeightMap& m) const {
    return mix(mix(m.at(x, y), m.at(x + 1, y), u), mix(m.at(x, y + 1), m.at(x + 1, y + 1), u), v);
  }
  Vec2d slope(const HeightMap& m) const {
    return {mix(m.at(x + 1, y) - m.at(x, y), m.at(x + 1, y + 1) - m.at(x, y + 1), v),
            mix(m.at(x, y + 1) - m.at(x, y), m.at(x + 1, y + 1) - m.at(x + 1, y), u)};
  }
  void add(HeightMap& m, double amount) const {
    m.at(x, y) += amount * (1 - u) * (1 - v);
    m.at(x + 1, y) += amount * u * (1 - v);
    m.at(x, y + 1) += amount * (1 - u) * v;
    m.at(x + 1, y + 1) += amount * u * v;
  }
};

/// Shares of the grid points around a place in what a drop takes away, most in the middle.
class Brush {
 public:
  static constexpr int kRadius = 3;

  Brush() {
    double total = 0;
    for_each([&](int i, int j, double& share) {
      share = std::max(0.0, kRadius - std::sqrt(static_cast<double>(i * i + j * j)));
      total += share;
    });
    for_each([&](int, int, double& share) { share /= total; });
  }

  void dig(HeightMap& map, int x, int y, double amount) {
    for_each([&](int i, int j, double share) {
      map.at(std::clamp(x + i, 0, map.size() - 1), std::clamp(y + j, 0, map.size() - 1)) -= amount * share;
    });
  }

 private:
  template <class F>
  void for_each(F&& f) {
    std::size_t k = 0;
    for (int j = -kRadius; j <= kRadius; ++j) {
      for (int i = -kRadius; i <= kRadius; ++i) f(i, j, shares_[k++]);
    }
  }

  std::array<double, (2 * kRadius + 1) * (2 * kRadius + 1)> shares_{};
};

/// One drop from its place until it leaves the map, dries up or stands still.
void run_drop(HeightMap& map, HeightMap& flow, Brush& brush, double x, double y) {
  constexpr double kInertia = 0.08, kCapacity = 5, kDrop = 0.3, kDig = 0.28, kDry = 0.015, kGravity = 4;
  constexpr int kSteps = 48;
  double dx = 0, dy = 0, speed = 1, water = 1, load = 0;
  for (int step = 0; step < kSteps; ++step) {
    const Bilinear here(x, y);
    const Vec2d slope = here.slope(map);
    dx = dx * kInertia - slope.x * (1 - kInertia);
    dy = dy * kInertia - slope.y * (1 - kInertia);
    const double length = std::sqrt(dx * dx + dy * dy);
    if (length < 1e-12) return;
    dx /= length;
    dy /= length;
    x += dx;
    y += dy;
    if (!(x >= 0 && y >= 0 && x < map.size() - 1 && y < map.size() - 1)) return;
    const double rise = Bilinear(x, y).height(map) - here.height(map);
    const double capacity = std::max(-rise, 0.0004) * speed * water * kCapacity;
    if (rise > 0 || load > capacity) {
      const double amount = rise > 0 ? std::min(rise, load) : (load - capacity) * kDrop;
      load -= amount;
      here.add(map, amount);
    } else {
      const double amount = std::min((capacity - load) * kDig, -rise);
      load += amount;
      brush.dig(map, here.x, here.y, amount);
    }
    flow.at(here.x, here.y) += water;
    speed = std::sqrt(std::max(0.0, speed * speed - rise * kGravity));
    water *= 1 - kDry;
  }
}

}  // namespace

double HeightMap::read(double x, double y) const {
  const double px = std::clamp(x, 0.0, 1.0) * (size_ - 1), py = std::clamp(y, 0.0, 1.0) * (size_ - 1);
  const int ix = std::min(static_cast<int>(px), size_ - 2), iy = std::min(static_cast<int>(py), size_ - 2);
  const auto wx = cubic_weights(px - ix), wy = cubic_weights(py - iy);
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    double row = 0;
    for (int i = 0; i < 4; ++i) {
      row += wx[static_cast<std::size_t>(i)] *
             at(std::clamp(ix + i - 1, 0, size_ - 1), std::clamp(iy + j - 1, 0, size_ - 1));
    }
    sum += wy[static_cast<std::size_t>(j)] * row;
  }
  return sum;
}

double HeightMap::read_linear(double x, double y) const {
  const double last = size_ - 1.000001;  // The point beyond is read, if with no weight.
  return Bilinear(std::clamp(x * (size_ - 1), 0.0, last), std::clamp(y * (size_ - 1), 0.0, last))
      .height(*this);
}

HeightMap make_mountains(int size, std::uint64_t seed) {
  HeightMap map(size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Vec2d p{static_cast<double>(x) / (size - 1), static_cast<double>(y) / (size - 1)};
      const Vec2d warp{fractal_noise(p * 3.0, 3, seed + 1), fractal_noise(p * 3.0, 3, seed + 2)};
      const Vec2d q = p + warp * 0.07;
      // A valley winds from the west to the south; the mountains stand away from it.
      const double valley = std::abs(q.y - 0.60 - 0.16 * std::sin(5.5 * q.x + 0.4)) / 0.34;
      const double high = smooth_step(0.05, 1.15, valley);
      const double ridges = ridged_noise(q * 3.1, 8, seed + 3);
      const double hills = 0.5 + 0.5 * fractal_noise(q * 4.5, 6, seed + 4);
      map.at(x, y) = 0.05 + 0.11 * hills + high * (0.08 + 0.95 * ridges * (0.55 + 0.45 * hills));
    }
  }
  return map;
}

HeightMap erode(HeightMap& map, int drops, std::uint64_t seed) {
  HeightMap flow(map.size());
  Random random(seed);
  Brush brush;
  for (int i = 0; i < drops; ++i) {
    const double x = random.uniform(0, map.size() - 1), y = random.uniform(0, map.size() - 1);
    run_drop(map, flow, brush, x, y);
  }
  return flow;
}

HeightMap blur(const HeightMap& map, int radius) {
  const int n = map.size();
  const auto at = [n](int i) { return std::clamp(i, 0, n - 1); };
  const auto pass = [&](const HeightMap& from, int dx, int dy) {
    HeightMap to(n);
    for (int line = 0; line < n; ++line) {
      double sum = 0;
      const auto value = [&](int i) { return dx ? from.at(at(i), line) : from.at(line, at(i)); };
      for (int i = -radius; i <= radius; ++i) sum += value(i);
      for (int i = 0; i < n; ++i) {
        (dy ? to.at(line, i) : to.at(i, line)) = sum / (2 * radius + 1);
        sum += value(i + radius + 1) - value(i - radius);
      }
    }
    return to;
  };
  return pass(pass(pass(pass(map, 1, 0), 0, 1), 1, 0), 0, 1);
}

HeightMap cast_light(const HeightMap& map, double east, double north, double up) {
  const int n = map.size();
  const double flat = std::hypot(east, north), rise = up / flat / (n - 1);
  const double dx = east / flat, dy = -north / flat;
  double top = 0;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) top = std::max(top, map.at(x, y));
  }
  HeightMap light(n);
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      double shade = 1;
      double ray = map.at(x, y);
      for (int step = 1; ray < top && shade > 0; ++step) {
        const double px = x + dx * step, py = y + dy * step;
        ray += rise;
        if (!(px >= 0 && py >= 0 && px < n - 1 && py < n - 1)) break;
        // The sun is a disc: a ridge that passes closely hides a part of it.
        const double clearance = (ray - Bilinear(px, py).height(map)) * (n - 1) / step;
        shade = std::min(shade, smooth_step(-0.03, 0.05, clearance));
      }
      light.at(x, y) = shade;
    }
  }
  return light;
}

}  // namespace fovea::sample
