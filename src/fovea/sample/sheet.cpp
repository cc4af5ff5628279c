#include "fovea/sample/sheet.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace fovea::sample {

namespace {

std::tuple<float, float, float> key(Vec3f p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

/// For each vertex the first one, in order of position, with the same position.
std::vector<std::uint32_t> first_with_position(const std::vector<Vec3f>& positions) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(key(positions[a]), a) < std::pair(key(positions[b]), b);
  });
  std::vector<std::uint32_t> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

double angle_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

void add_triangle(SplitPart& part, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto& p = part.positions;
  if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
  part.indices.insert(part.indices.end(), {a, b, c});
}

}  // namespace

SplitPart make_part(int material) {
  SplitPart part;
  part.part.material = material;
  VertexArray uv;
  uv.semantic = Semantic::uv;
  uv.width = 2;
  part.attributes.push_back(std::move(uv));
  return part;
}

VertexArray* find_attribute(SplitPart& part, Semantic semantic) {
  for (VertexArray& a : part.attributes) {
    if (a.semantic == semantic) return &a;
  }
  return nullptr;
}

std::size_t add_sheet(SplitPart& part, const Sheet& sheet) {
  const std::size_t first = part.positions.size();
  std::vector<float>& uvs = find_attribute(part, Semantic::uv)->values;
  for (int row = 0; row <= sheet.rows; ++row) {
    for (int column = 0; column <= sheet.columns; ++column) {
      part.positions.push_back(Vec3f(sheet.position(column, row)));
      const Vec2d uv = sheet.uv(column, row);
      uvs.push_back(static_cast<float>(uv.x));
      uvs.push_back(static_cast<float>(uv.y));
    }
  }
  const auto stride = static_cast<std::uint32_t>(sheet.columns) + 1;
  for (int row = 0; row < sheet.rows; ++row) {
    for (int column = 0; column < sheet.columns; ++column) {
      const std::uint32_t a = static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(row) * stride +
                              static_cast<std::uint32_t>(column);
      const std::uint32_t b = a + 1, c = a + 1 + stride, d = a + stride;
      add_triangle(part, a, b, c);
      add_triangle(part, a, c, d);
    }
  }
  return first;
}

std::vector<float> smooth_normals(const SplitPart& part, const std::vector<Vec3f>& positions) {
  const std::vector<std::uint32_t> first = first_with_position(part.positions);
  std::vector<Vec3d> sums(positions.size());
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = [&](std::size_t j) { return part.indices[i + (k + j) % 3]; };
      const Vec3d p(positions[corner(0)]);
      const Vec3d a = Vec3d(positions[corner(1)]) - p, b = Vec3d(positions[corner(2)]) - p;
      sums[first[corner(0)]] += normalized(cross(a, b)) * angle_between(a, b);
    }
  }
  std::vector<float> normals;
  normals.reserve(positions.size() * 3);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3d n = normalized(sums[first[v]]);
    normals.insert(normals.end(),
                   {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  }
  return normals;
}

void add_normals(SplitPart& part) {
  VertexArray normals;
  normals.semantic = Semantic::normal;
  normals.width = 3;
  normals.values = smooth_normals(part, part.positions);
  part.attributes.push_back(std::move(normals));
}

int scaled(int base, double detail) {
  return std::max(4, static_cast<int>(std::lround(base * std::sqrt(detail))));
}

}  // namespace fovea::sample
