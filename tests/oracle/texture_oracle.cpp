#include "oracle/texture_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace fovea::test {

namespace {

int wrapped(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::clamp: return std::clamp(i, 0, size - 1);
    case Wrap::repeat:
      while (i < 0) i += size;
      return i % size;
    case Wrap::mirror:
      while (i < 0) i += 2 * size;
      i %= 2 * size;
      return i < size ? i : 2 * size - 1 - i;
  }
  return 0;
}

double stored(const Image8& image, const Sampler& sampler, int x, int y, int channel) {
  const std::uint8_t* texel =
      image.at(wrapped(x, image.width, sampler.wrap_u), wrapped(y, image.height, sampler.wrap_v));
  return texel[image.channels < 3 ? 0 : channel];
}

Vec3d position(const TriMesh& mesh, std::size_t corner) {
  return Vec3d(mesh.positions[mesh.triangles[corner / 3][corner % 3].index()]);
}

}  // namespace

std::array<double, 3> smooth_color(const Image8& image, const Sampler& sampler, int x, int y) {
  std::array<double, 3> color{};
  for (int k = 0; k < 3; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i)
        color[static_cast<std::size_t>(k)] +=
            (2 - std::abs(i)) * (2 - std::abs(j)) * stored(image, sampler, x + i, y + j, k) / (16 * 255.0);
    }
  }
  return color;
}

double counted_entropy(const Image8& image, const Sampler& sampler, const TextureSignalOptions& options,
                       int x, int y) {
  std::map<int, double> count;
  const int half = options.entropy_window / 2;
  for (int j = y - half; j <= y + half; ++j) {
    for (int i = x - half; i <= x + half; ++i) {
      const auto [r, g, b] = smooth_color(image, sampler, wrapped(i, image.width, sampler.wrap_u),
                                          wrapped(j, image.height, sampler.wrap_v));
      const double grey = 0.30 * r + 0.59 * g + 0.11 * b;
      // A grey between two bins belongs to the upper one.
      const int bin = static_cast<int>(std::floor(grey * options.entropy_bins + 1e-9));
      ++count[std::min(bin, options.entropy_bins - 1)];
    }
  }
  double entropy = 0;
  for (const auto& [bin, c] : count) {
    const double p = c / (options.entropy_window * options.entropy_window);
    entropy -= p * std::log2(p);
  }
  return entropy;
}

TexelGather::TexelGather(const TriMesh& mesh, const TextureRef& ref, int width, int height)
    : mesh_(mesh), width_(width), height_(height), vertex_corners_(mesh.vertex_count()) {
  const AttributeLayer& layer = *mesh.find(Semantic::uv, ref.uv_set);
  const TextureTransform t = ref.transform.value_or(TextureTransform{});
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    const float* uv = layer.value(layer.corner_value[c]);
    const double u = t.scale.x * static_cast<double>(uv[0]), v = t.scale.y * static_cast<double>(uv[1]);
    const double cosine = std::cos(t.rotation_rad), sine = std::sin(t.rotation_rad);
    corner_texel_.push_back(
        {(t.offset.x + cosine * u + sine * v) * width, (t.offset.y - sine * u + cosine * v) * height});
    vertex_corners_[mesh.triangles[c / 3][c % 3].index()].push_back(static_cast<std::uint32_t>(c));
  }
  // Charts: triangles that share a texture coordinate.
  std::vector<std::uint32_t> parent(layer.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t c = 0; c < 3 * mesh.face_count(); c += 3) {
    for (std::size_t k = 1; k < 3; ++k)
      parent[root(layer.corner_value[c + k].value)] = root(layer.corner_value[c].value);
  }
  for (const ValueId value : layer.corner_value) corner_chart_.push_back(root(value.value));
}

std::optional<std::array<double, 3>> TexelGather::average(const TextureSignals& signals, std::uint32_t vertex,
                                                          double radius) const {
  const Vec3d v(mesh_.positions[vertex]);
  const ImageF* const planes[] = {&signals.intensity, &signals.opponency, &signals.entropy};
  std::array<double, 3> sums{};
  double weights = 0;
  for (std::size_t face = 0; face < mesh_.face_count(); ++face) {
    const std::size_t c = 3 * face;
    bool touches = false;
    for (std::size_t k = 0; k < 3; ++k) touches = touches || length(position(mesh_, c + k) - v) <= radius;
    if (!touches) continue;
    const Vec2d t0 = corner_texel_[c], a = corner_texel_[c + 1] - t0, b = corner_texel_[c + 2] - t0;
    const Vec3d p0 = position(mesh_, c), ea = position(mesh_, c + 1) - p0, eb = position(mesh_, c + 2) - p0;
    const double area = cross(a, b);
    if (area == 0) continue;
    // The affine map from the texture to the surface, of differences.
    const auto on_surface = [&](Vec2d d) { return ea * (cross(d, b) / area) + eb * (cross(a, d) / area); };
    std::vector<Vec2d> centers;
    for (const std::uint32_t corner : vertex_corners_[vertex]) {
      if (corner_chart_[corner] == corner_chart_[c]) centers.push_back(corner_texel_[corner]);
    }
    const auto [left, right] = std::minmax({t0.x, t0.x + a.x, t0.x + b.x});
    const auto [top, bottom] = std::minmax({t0.y, t0.y + a.y, t0.y + b.y});
    for (int y = static_cast<int>(std::floor(top)); y <= bottom; ++y) {
      for (int x = static_cast<int>(std::floor(left)); x <= right; ++x) {
        const Vec2d te{x + 0.5, y + 0.5};
        const double s = cross(te - t0, b) / area, t = cross(a, te - t0) / area;
        if (s < 0 || t < 0 || s + t > 1) continue;
        double ratio = std::numeric_limits<double>::infinity();  // of ‖TE − TE_V‖ and r'
        for (const Vec2d center : centers) {
          const Vec2d d = te - center;
          const double from_center = std::hypot(d.x, d.y);
          const double ellipse = from_center > 0 ? from_center * radius / length(on_surface(d)) : radius;
          ratio = std::min(ratio, from_center / ellipse);
        }
        if (centers.empty()) ratio = length(p0 + on_surface(te - t0) - v) / radius;
        if (ratio > 1) continue;
        const double weight = std::exp(-ratio * ratio / 2);
        const int column = wrapped(x, width_, Wrap::repeat), row = wrapped(y, height_, Wrap::repeat);
        for (std::size_t k = 0; k < 3; ++k)
          sums[k] += weight * static_cast<double>(*planes[k]->at(column, row));
        weights += weight;
      }
    }
  }
  if (weights == 0) return {};
  for (double& sum : sums) sum /= weights;
  return sums;
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ranks = [](const std::vector<double>& x) {
    std::vector<std::size_t> order(x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return x[i] < x[j]; });
    std::vector<double> rank(x.size());
    for (std::size_t i = 0; i < order.size();) {
      std::size_t end = i;
      while (end < order.size() && x[order[end]] == x[order[i]]) ++end;
      for (std::size_t k = i; k < end; ++k) rank[order[k]] = static_cast<double>(i + end - 1) / 2;
      i = end;
    }
    return rank;
  };
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double mean = static_cast<double>(x.size() - 1) / 2;
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean) * (y[i] - mean);
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0;
}

}  // namespace fovea::test
