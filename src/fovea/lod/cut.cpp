#include "fovea/lod/cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/error.h"

namespace fovea {

namespace {

bool has_all(const Cut& cut, std::span<const std::uint32_t> needs) {
  return std::all_of(needs.begin(), needs.end(), [&](std::uint32_t s) { return cut[s] != 0; });
}

/// As many steps as there are for which `allows(s)`, asked in order and only when all that s needs is taken.
template <class Allows>
Cut take_where(const MultiTessellation& levels, Allows&& allows) {
  Cut cut(levels.step_count(), 0);
  for (std::size_t s = 0; s < cut.size(); ++s) cut[s] = has_all(cut, levels.needs_of(s)) && allows(s);
  return cut;
}

void check(const MultiTessellation& levels, std::span<const float> allowed) {
  if (allowed.size() != levels.first_vertex.back())
    throw Error(ErrorKind::usage, "there must be one allowed error for each vertex of all meshes", "allowed");
  for (const float a : allowed) {
    if (!(a >= 0)) throw Error(ErrorKind::usage, "an allowed error is negative or no number", "allowed");
  }
}

/// The rule of `cut_within` with all that is allowed multiplied by a factor.
Cut take_within(const MultiTessellation& levels, std::span<const float> allowed, double factor) {
  std::vector<float> at_vertex(allowed.begin(), allowed.end());
  return take_where(levels, [&](std::size_t s) {
    const CollapseStep& step = levels.record.steps[s];
    float least = std::numeric_limits<float>::infinity();
    for (const std::uint32_t v : levels.corners_of(s)) least = std::min(least, at_vertex[v]);
    if (step.kind == StepKind::collapse)
      least = std::min(least, at_vertex[levels.vertex(step.mesh, step.removed)]);
    if (levels.error[s] > factor * least) return false;
    if (step.kind == StepKind::collapse) {
      float& kept = at_vertex[levels.vertex(step.mesh, step.kept)];
      kept = std::min(kept, at_vertex[levels.vertex(step.mesh, step.removed)]);
    }
    return true;
  });
}

}  // namespace

std::uint64_t triangles_of(const MultiTessellation& levels, const Cut& cut) {
  std::uint64_t left = levels.triangles;
  for (std::size_t s = 0; s < cut.size(); ++s) {
    if (cut[s] != 0) left -= levels.removed_by(s);
  }
  return left;
}

Cut cut_at_triangles(const MultiTessellation& levels, std::uint64_t triangles) {
  Cut cut(levels.step_count(), 0);
  std::fill_n(cut.begin(), levels.record.steps_to(triangles), std::uint8_t{1});
  return cut;
}

Cut cut_leaving_meshes(const Model& original, const MultiTessellation& levels) {
  std::vector<std::size_t> left;
  for (const Mesh& mesh : original.meshes) left.push_back(mesh.surface.face_count());
  Cut cut(levels.step_count(), 1);
  for (std::size_t s = 0; s < cut.size(); ++s) {
    std::size_t& faces = left[levels.record.steps[s].mesh];
    cut[s] = faces > levels.removed_by(s) && has_all(cut, levels.needs_of(s));
    if (cut[s] != 0) faces -= levels.removed_by(s);
  }
  return cut;
}

Cut cut_at_error(const MultiTessellation& levels, double error) {
  return take_where(levels, [&](std::size_t s) { return levels.error[s] <= error; });
}

Cut cut_within(const MultiTessellation& levels, std::span<const float> allowed) {
  check(levels, allowed);
  return take_within(levels, allowed, 1);
}

Cut cut_within(const MultiTessellation& levels, std::span<const float> allowed, std::uint64_t triangles,
               double* factor) {
  check(levels, allowed);
  constexpr double kFine = 1.001, kLargest = 0x1p100;
  double high = 1;
  Cut best = take_within(levels, allowed, high);
  const bool grows = triangles_of(levels, best) > triangles;
  double low = high;
  // Powers of two on both sides of the factor ...
  while (grows && high < kLargest && triangles_of(levels, best) > triangles) {
    low = high;
    best = take_within(levels, allowed, high *= 2);
  }
  while (!grows && low > 1 / kLargest) {
    Cut finer = take_within(levels, allowed, low /= 2);
    if (triangles_of(levels, finer) > triangles) break;
    best = std::move(finer);
    high = low;
  }
  // ... that come together.
  while (high / low > kFine) {
    const double middle = std::sqrt(low * high);
    Cut between = take_within(levels, allowed, middle);
    if (triangles_of(levels, between) > triangles) {
      low = middle;
    } else {
      best = std::move(between);
      high = middle;
    }
  }
  if (factor != nullptr) *factor = high;
  return best;
}

Model level_of(const Model& original, const MultiTessellation& levels, const Cut& cut) {
  std::vector<const TriMesh*> sources;
  for (const Mesh& mesh : original.meshes) sources.push_back(&mesh.surface);
  std::vector<TriMesh> meshes = replay(sources, levels.record, cut);
  Model level = original;
  for (std::size_t m = 0; m < meshes.size(); ++m) level.meshes[m].surface = std::move(meshes[m]);
  return level;
}

}  // namespace fovea
