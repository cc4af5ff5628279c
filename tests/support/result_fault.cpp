#include "support/result_fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/model/weld.h"

namespace fovea::test {

namespace {

/// Keeps the first fault.
class Faults {
 public:
  void expect(bool holds, const char* what) {
    if (!holds && first_.empty()) first_ = where_.empty() ? what : fmt::format("{}: {}", where_, what);
  }
  void at(std::string where) { where_ = std::move(where); }
  bool none() const { return first_.empty(); }
  const std::string& first() const { return first_; }

 private:
  std::string where_, first_;
};

bool is_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

/// Edges that an odd number of triangles is on. `corner_id` says for each corner what stands for its vertex,
/// kInvalid where there is nothing. No collapse adds one: it maps edges to edges.
template <class CornerIdentity>
std::size_t odd_edges(const TriMesh& mesh, CornerIdentity&& corner_id) {
  std::map<std::array<std::uint32_t, 2>, bool> odd;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corner_id(3 * f + k), b = corner_id(3 * f + (k + 1) % 3);
      if (a == kInvalid || b == kInvalid) continue;
      bool& is_odd = odd[{std::min(a, b), std::max(a, b)}];
      is_odd = !is_odd;
    }
  }
  return static_cast<std::size_t>(
      std::count_if(odd.begin(), odd.end(), [](const auto& edge) { return edge.second; }));
}

std::size_t odd_edges(const TriMesh& mesh) {
  return odd_edges(mesh, [&](std::size_t c) { return mesh.vertex(CornerId{c}).value; });
}

std::size_t odd_edges(const TriMesh& mesh, const AttributeLayer& layer) {
  return odd_edges(mesh, [&](std::size_t c) {
    const ValueId value = layer.corner_value[c];
    return value.valid() ? value.value : kInvalid;
  });
}

/// Vertices less edges plus triangles, and pieces that hang together at vertices.
struct Topology {
  std::int64_t euler = 0;
  std::size_t pieces = 0;
  bool manifold = true;  ///< At most two triangles on each edge, and none on each other.
  friend bool operator==(const Topology&, const Topology&) = default;
};

Topology topology_of(const TriMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> edges;
  std::vector<std::uint32_t> root(mesh.vertex_count());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::set<std::uint32_t> used;
  std::set<std::array<VertexId, 3>> triangles;
  Topology topology;
  for (auto t : mesh.triangles) {
    std::sort(t.begin(), t.end());
    topology.manifold &= triangles.insert(t).second;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k].value, b = t[(k + 1) % 3].value;
      ++edges[{std::min(a, b), std::max(a, b)}];
      used.insert(a);
      root[find(a)] = find(b);
    }
  }
  topology.euler =
      static_cast<std::int64_t>(used.size() + mesh.face_count()) - static_cast<std::int64_t>(edges.size());
  for (const std::uint32_t v : used) topology.pieces += find(v) == v;
  for (const auto& [edge, faces] : edges) topology.manifold &= faces <= 2;
  return topology;
}

using Place = std::array<float, 3>;

std::set<Place> places(const TriMesh& mesh) {
  std::set<Place> all;
  for (const auto& t : mesh.triangles) {
    for (const VertexId v : t) {
      const Vec3f p = mesh.positions[v.index()];
      all.insert({p.x, p.y, p.z});
    }
  }
  return all;
}

/// Where vertices are that must stay.
std::set<Place> held_places(const TriMesh& mesh, const VertexField* importance, bool lock_boundary) {
  std::set<Place> held;
  std::map<std::array<std::uint32_t, 2>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k].value, b = t[(k + 1) % 3].value;
      ++edges[{std::min(a, b), std::max(a, b)}];
      const Vec3f p = mesh.positions[a];
      if (importance != nullptr && std::isinf((*importance)[t[k]])) held.insert({p.x, p.y, p.z});
    }
  }
  for (const auto& [edge, faces] : edges) {
    if (!lock_boundary || faces != 1) continue;
    for (const std::uint32_t v : edge) {
      const Vec3f p = mesh.positions[v];
      held.insert({p.x, p.y, p.z});
    }
  }
  return held;
}

bool includes(const std::set<Place>& all, const std::set<Place>& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

void look_at_influences(const TriMesh& mesh, Faults& faults) {
  if (mesh.find(Semantic::weights) == nullptr) return;
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    double sum = 0;
    for (const AttributeLayer& layer : mesh.layers) {
      if (layer.semantic != Semantic::weights && layer.semantic != Semantic::joints) continue;
      const float* value = layer.value(layer.corner_value[c]);
      for (int k = 0; k < layer.width; ++k) {
        if (layer.semantic == Semantic::weights) sum += value[k];
        faults.expect(value[k] >= 0, "an influence is negative");
        // Models of support/any_model.h have three joints.
        if (layer.semantic == Semantic::joints)
          faults.expect(value[k] < 3 && value[k] == std::floor(value[k]), "a joint is not there");
      }
    }
    faults.expect(std::abs(sum - 1) < 1e-4, "weights do not add up to one");
  }
}

void look_at_values(const TriMesh& mesh, Faults& faults) {
  for (const AttributeLayer& layer : mesh.layers) {
    faults.expect(is_finite(layer.values), "a value is not finite");
    for (const auto& morph : layer.morphs) faults.expect(is_finite(morph), "a morph of values is not finite");
    for (std::size_t i = 0; i < layer.size(); ++i) {
      const float* v = layer.value(ValueId{i});
      if (layer.semantic == Semantic::normal || layer.semantic == Semantic::tangent)
        faults.expect(std::abs(length(Vec3d{v[0], v[1], v[2]}) - 1) < 1e-3,
                      "a normal or tangent is not unit");
      if (layer.semantic == Semantic::tangent) faults.expect(std::abs(v[3]) == 1, "a tangent has no side");
      if (layer.semantic == Semantic::color) {
        for (int k = 0; k < layer.width; ++k)
          faults.expect(v[k] >= 0 && v[k] <= 1, "a colour is not within 0 and 1");
      }
    }
  }
  for (const auto& morph : mesh.position_morphs) {
    for (const Vec3f& p : morph)
      faults.expect(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "a morph is not finite");
  }
}

void look_at_places(const SimplifyRun& run, std::size_t m, Faults& faults) {
  const TriMesh &before = run.model.meshes[m].surface, &after = run.result.model.meshes[m].surface;
  if (run.options.cull_hidden) return;
  const std::set<Place> now = places(after);
  const VertexField* importance = run.importance.empty() ? nullptr : &run.importance[m];
  faults.expect(includes(now, held_places(before, importance, run.options.lock_boundary)),
                "a locked vertex is not where it was");
  if (run.options.placement == Placement::half_edge)
    faults.expect(includes(places(before), now), "a vertex is where none was");
}

void look_at_topology(const SimplifyRun& run, std::size_t m, Faults& faults) {
  const TriMesh &before = run.model.meshes[m].surface, &after = run.result.model.meshes[m].surface;
  if (run.options.cull_hidden) return;
  faults.expect(odd_edges(after) <= odd_edges(before), "the surface is torn");
  // Otherwise triangles that come to lie back to back may go, whatever their values.
  if (!run.options.keep_topology) return;
  for (std::size_t l = 0; l < before.layers.size(); ++l)
    faults.expect(odd_edges(after, after.layers[l]) <= odd_edges(before, before.layers[l]),
                  "a layer is torn");
  const Topology was = topology_of(before);
  if (was.manifold) faults.expect(topology_of(after) == was, "the topology is another");
}

void look_at_mesh(const SimplifyRun& run, std::size_t m, Faults& faults) {
  const TriMesh& after = run.result.model.meshes[m].surface;
  try {
    check(after);
    Context context;
    faults.expect(weld(split(after), context).face_count() == after.face_count(),
                  "a triangle has two corners at one place");
  } catch (const Error& error) {
    faults.expect(false, error.what());
  }
  if (!faults.none()) return;
  look_at_values(after, faults);
  look_at_influences(after, faults);
  look_at_places(run, m, faults);
  look_at_topology(run, m, faults);
}

void look_at_counts(const SimplifyRun& run, Faults& faults) {
  const SimplifyResult& result = run.result;
  std::uint64_t before = 0, after = 0;
  for (const Mesh& mesh : run.model.meshes) before += mesh.surface.face_count();
  for (const Mesh& mesh : result.model.meshes) after += mesh.surface.face_count();
  faults.expect(result.triangles_before == before, "triangles_before is wrong");
  faults.expect(result.triangles_after == after, "triangles_after is wrong");
  faults.expect(result.record.triangles_before == before, "the record's count is wrong");
  faults.expect(result.record.triangles_after(result.record.steps.size()) == after,
                "the record leads to another count");
  float last = 0;
  for (const CollapseStep& step : result.record.steps) {
    faults.expect(step.error_rel >= last, "an error falls, or is no number");
    if (!run.options.per_mesh) last = step.error_rel;  // else steps go mesh by mesh
  }
}

void look_at_stop(const SimplifyRun& run, Faults& faults) {
  const SimplifyResult& result = run.result;
  const SimplifyOptions& options = run.options;
  const bool counts = options.ratio || options.triangles;
  faults.expect(std::isfinite(result.error_rel) && result.error_rel >= 0, "error_rel is no error");
  faults.expect(std::isfinite(result.error_abs) && result.error_abs >= 0, "error_abs is no error");
  faults.expect(result.metric != Metric::automatic, "the metric is not told");
  if (options.error) faults.expect(result.error_rel <= *options.error * (1 + 1e-6), "error_rel is exceeded");
  if (options.error_abs)
    faults.expect(result.error_abs <= *options.error_abs * (1 + 1e-6), "error_abs is exceeded");
  switch (result.stop) {
    case StopReason::target:
      faults.expect(result.triangles_after <= result.triangles_target || !counts, "the target is missed");
      break;
    case StopReason::error:
      faults.expect(options.error || options.error_abs, "there is no bound to stop at");
      break;
    case StopReason::stuck: {
      const BlockCounts& b = result.blocked;
      faults.expect(b.edges == b.topology + b.flip + b.locked + b.last, "edges are not accounted for");
      break;
    }
    case StopReason::cancelled: faults.expect(false, "nobody cancelled"); break;
  }
}

bool same_mesh(const TriMesh& a, const TriMesh& b, std::string& what) {
  const auto morphs_same = [](const auto& x, const auto& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end());
  };
  if (a.positions != b.positions) what = "positions";
  if (a.triangles != b.triangles || a.face_part != b.face_part) what = "triangles";
  if (!morphs_same(a.position_morphs, b.position_morphs)) what = "position morphs";
  if (a.source_vertex != b.source_vertex) what = "source vertices";
  if (a.layers.size() != b.layers.size()) what = "number of layers";
  for (std::size_t l = 0; what.empty() && l < a.layers.size(); ++l) {
    if (!same_bits(a.layers[l].values, b.layers[l].values)) what = "values";
    if (a.layers[l].corner_value != b.layers[l].corner_value) what = "corners";
    if (!morphs_same(a.layers[l].morphs, b.layers[l].morphs)) what = "morphs of values";
  }
  return what.empty();
}

std::string difference(const Model& a, const Model& b) {
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    std::string what;
    if (!same_mesh(a.meshes[m].surface, b.meshes[m].surface, what))
      return fmt::format("mesh {} has other {}", m, what);
  }
  return {};
}

}  // namespace

std::string fault_of(const SimplifyRun& run) {
  Faults faults;
  look_at_counts(run, faults);
  look_at_stop(run, faults);
  for (std::size_t m = 0; m < run.model.meshes.size() && faults.none(); ++m) {
    faults.at(fmt::format("mesh {}", m));
    look_at_mesh(run, m, faults);
  }
  if (!faults.none()) return faults.first();
  const CollapseRecord& record = run.result.record;
  const std::string other = difference(replay(run.model, record, record.steps.size()), run.result.model);
  return other.empty() ? "" : "replayed: " + other;
}

std::string difference(const SimplifyResult& a, const SimplifyResult& b) {
  if (a.record.steps.size() != b.record.steps.size()) return "another number of steps";
  if (!same_bits(a.record.floats, b.record.floats)) return "other numbers in the record";
  if (a.stop != b.stop || a.error_rel != b.error_rel) return "another end";
  return difference(a.model, b.model);
}

}  // namespace fovea::test
