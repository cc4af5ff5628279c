#include "level_check.h"

#include <algorithm>
#include <numeric>

#include "fovea/base/error.h"
#include "fovea/surface/topology.h"

namespace fovea::bench {

namespace {

bool is_open(const std::array<int, 2>& edge) { return edge[0] + edge[1] == 1; }
bool is_non_manifold(const std::array<int, 2>& edge) { return edge[0] > 1 || edge[1] > 1; }

Vec3d normal(const Surface& surface, const std::array<std::uint32_t, 3>& t) {
  const Vec3d a = surface.position(t[0]);
  return normalized(cross(surface.position(t[1]) - a, surface.position(t[2]) - a));
}

bool is_sound(const TriMesh& mesh) {
  try {
    check(mesh);
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::size_t count_doubled(const TriMesh& mesh) {
  KeyTable different(3, mesh.face_count());
  for (const auto& [a, b, c] : mesh.triangles) {
    std::array<std::uint32_t, 3> key{a.value, b.value, c.value};
    std::ranges::sort(key);
    different.insert(key);
  }
  return mesh.face_count() - different.size();
}

}  // namespace

LevelCheck::LevelCheck(const Model& original, const MultiTessellation& levels, const LiveLevel& live)
    : levels_(levels), live_(live), scales_(largest_scales(original)) {
  for (const Mesh& mesh : original.meshes) {
    surfaces_.push_back(surface_of(mesh.surface));
    shown_.push_back(mesh.surface.triangles);
  }
  for (const Surface& surface : surfaces_) {
    nearest_.emplace_back(surface);
    facing_.emplace_back(surface, std::vector<std::uint32_t>(surface.triangles.size()));
  }
  for (std::uint32_t m = 0; m < shown_.size(); ++m) {
    for (const Corners& t : shown_[m]) add(triangles_[triangle(m, t)], 1);
  }
  for (std::uint32_t m = 0; m < shown_.size(); ++m) {
    for (const Corners& t : shown_[m]) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = levels.vertex(m, t[k]), b = levels.vertex(m, t[(k + 1) % 3]);
        const std::array<int, 2>& on_edge = edges_[edge(a, b)];
        if ((on_edge[0] + on_edge[1]) % 2 == 1) borders_.push_back({a, b});
      }
    }
  }
}

LevelFaults LevelCheck::update() {
  for (std::uint32_t m = 0; m < shown_.size(); ++m) {
    for (std::size_t f = 0; f < shown_[m].size(); ++f) {
      const Corners corners = live_.is_there(m, FaceId{f}) ? live_.mesh(m).triangles[f] : Corners{};
      Corners& shown = shown_[m][f];
      if (corners == shown) continue;
      if (shown[0].valid()) add(triangles_[triangle(m, shown)], -1);
      if (corners[0].valid()) add(triangles_[triangle(m, corners)], 1);
      shown = corners;
    }
  }
  now_.cracks = count_cracks();
  now_.flipped = now_.turned > 0 ? count_flipped() : 0;
  return now_;
}

bool LevelCheck::is_same(const Model& level) const {
  std::size_t open = 0, non_manifold = 0, doubled = 0;
  for (std::size_t m = 0; m < shown_.size(); ++m) {
    const TriMesh& mesh = level.meshes[m].surface;
    if (!is_sound(mesh)) return false;
    std::size_t f = 0;
    for (const Corners& shown : shown_[m]) {
      if (!shown[0].valid()) continue;
      if (f == mesh.face_count()) return false;
      for (std::size_t k = 0; k < 3; ++k) {
        if (!(mesh.positions[mesh.triangles[f][k].index()] == surfaces_[m].positions[shown[k].index()]))
          return false;
      }
      ++f;
    }
    if (f != mesh.face_count()) return false;
    const EdgeCounts edges = count_edges(mesh);
    open += edges.boundary;
    non_manifold += edges.non_manifold;
    doubled += count_doubled(mesh);
  }
  return open == open_ && non_manifold == now_.non_manifold && doubled == now_.doubled;
}

/// The number of a triangle, which is looked at when it comes for the first time.
std::uint32_t LevelCheck::triangle(std::uint32_t mesh, const Corners& corners) {
  std::array<std::uint32_t, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) v[k] = levels_.vertex(mesh, corners[k]);
  std::rotate(v.begin(), std::ranges::min_element(v), v.end());
  const std::uint32_t number = triangle_numbers_.insert(v);
  if (number < triangles_.size()) return number;
  Triangle& made = triangles_.emplace_back();
  for (std::size_t k = 0; k < 3; ++k) {
    made.edges[k] = edge(v[k], v[(k + 1) % 3]);
    made.forward[k] = v[k] < v[(k + 1) % 3];
  }
  std::ranges::sort(v);
  made.vertices = vertices_numbers_.insert(v);
  times_.resize(vertices_numbers_.size());
  made.turned = error_that_turns(mesh, corners);
  return number;
}

std::uint32_t LevelCheck::edge(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t number = edge_numbers_.insert(std::array{std::min(a, b), std::max(a, b)});
  edges_.resize(edge_numbers_.size());
  return number;
}

float LevelCheck::error_that_turns(std::uint32_t mesh, const Corners& corners) const {
  const Surface& surface = surfaces_[mesh];
  const std::array<std::uint32_t, 3> t{corners[0].value, corners[1].value, corners[2].value};
  const Vec3d a = surface.position(t[0]), b = surface.position(t[1]), c = surface.position(t[2]);
  const Vec3d center = (a + b + c) / 3.0, n = normal(surface, t);
  const std::uint32_t before = nearest_[mesh].nearest(center).triangle;
  if (dot(n, normal(surface, surface.triangles[before])) >= -0.5) return 0;
  const double height = length(cross(b - a, c - a)) / std::max({length(b - a), length(c - b), length(a - c)});
  const auto hit = facing_[mesh].nearest({center, n, height, 0});
  return static_cast<float>(scales_[mesh] / 2 * (hit ? hit->distance : height));
}

void LevelCheck::add(const Triangle& triangle, int times) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<int, 2>& edge = edges_[triangle.edges[k]];
    open_ -= is_open(edge);
    now_.non_manifold -= is_non_manifold(edge);
    edge[triangle.forward[k]] += times;
    open_ += is_open(edge);
    now_.non_manifold += is_non_manifold(edge);
  }
  int& all = times_[triangle.vertices];
  now_.doubled -= static_cast<std::size_t>(std::max(all - 1, 0));
  all += times;
  now_.doubled += static_cast<std::size_t>(std::max(all - 1, 0));
  if (triangle.turned > 0) now_.turned += static_cast<std::size_t>(times);
}

std::size_t LevelCheck::count_cracks() {
  // What each vertex has become: a step that is taken later has the say first.
  std::vector<std::uint32_t> target(levels_.first_vertex.back());
  std::iota(target.begin(), target.end(), 0u);
  for (std::size_t s = levels_.step_count(); s-- > 0;) {
    const CollapseStep& step = levels_.record.steps[s];
    if (live_.cut()[s] != 0 && step.kind == StepKind::collapse)
      target[levels_.vertex(step.mesh, step.removed)] = target[levels_.vertex(step.mesh, step.kept)];
  }
  std::size_t cracks = open_;
  std::vector<std::uint8_t> counted;
  for (const auto& [a, b] : borders_) {
    const std::uint32_t e = edge(target[a], target[b]);
    counted.resize(edges_.size());
    if (!counted[e] && is_open(edges_[e])) --cracks;
    counted[e] = 1;
  }
  return cracks;
}

std::size_t LevelCheck::count_flipped() {
  float error = 0;
  for (std::size_t s = 0; s < levels_.step_count(); ++s)
    if (live_.cut()[s] != 0) error = std::max(error, levels_.error[s]);
  std::size_t flipped = 0;
  for (std::uint32_t m = 0; m < shown_.size(); ++m) {
    for (const Corners& t : shown_[m]) flipped += t[0].valid() && triangles_[triangle(m, t)].turned > error;
  }
  return flipped;
}

}  // namespace fovea::bench
