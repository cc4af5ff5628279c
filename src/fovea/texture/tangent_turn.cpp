#include "fovea/texture/tangent_turn.h"

#include <cassert>
#include <cmath>

namespace fovea {

namespace {

/// The edges of a triangle from its first corner in its own plane, seen from outside.
std::array<Vec2d, 2> edges_in_plane(const TriMesh& mesh, std::uint32_t face) {
  const auto at = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.triangles[face][k].index()]); };
  const Vec3d a = at(1) - at(0), b = at(2) - at(0);
  const double along = length(a);
  if (along == 0) return {};
  return {Vec2d{along, 0}, Vec2d{dot(a, b) / along, length(cross(a, b)) / along}};
}

/// Where coordinates grow to the right and upwards; not scaled.
struct Frame {
  Vec2d tangent, bitangent;
};

Frame frame_of(const std::array<Vec2d, 2>& edges, const std::array<Vec2d, 3>& uv) {
  const Vec2d a = uv[1] - uv[0], b = uv[2] - uv[0];
  const double area = cross(a, b), sign = area < 0 ? -1 : 1;
  return {(edges[0] * b.y - edges[1] * a.y) * sign, (edges[0] * b.x - edges[1] * a.x) * sign};
}

double turn(const Frame& from, const Frame& to) {
  const Vec2d t = from.tangent, other = to.tangent;
  const double angle = std::atan2(cross(t, other), t.x * other.x + t.y * other.y);
  return cross(t, from.bitangent) < 0 ? -angle : angle;
}

}  // namespace

std::vector<std::array<float, 3>> tangent_turns(const Model& model, std::span<const AtlasFace> from,
                                                std::span<const AtlasFace> to) {
  assert(from.size() == to.size());
  const auto has_tangents = [&](const AtlasFace& face) {
    return model.meshes[face.mesh].surface.find(Semantic::tangent) != nullptr;
  };
  std::vector<Vec2d> sums;  // of values: cosine and sine by area
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (has_tangents(from[i])) continue;
    const std::array<Vec2d, 2> edges = edges_in_plane(model.meshes[from[i].mesh].surface, from[i].face);
    const double area = cross(edges[0], edges[1]);
    const double angle = turn(frame_of(edges, from[i].uv), frame_of(edges, to[i].uv));
    for (const std::uint32_t value : from[i].value) {
      if (value >= sums.size()) sums.resize(value + std::size_t{1});
      sums[value] = sums[value] + Vec2d{std::cos(angle), std::sin(angle)} * area;
    }
  }
  std::vector<std::array<float, 3>> turns(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (has_tangents(from[i])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2d sum = sums[from[i].value[k]];
      turns[i][k] = static_cast<float>(std::atan2(sum.y, sum.x));
    }
  }
  return turns;
}

}  // namespace fovea
