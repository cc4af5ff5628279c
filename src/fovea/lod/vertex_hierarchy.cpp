#include "fovea/lod/vertex_hierarchy.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "fovea/base/error.h"
#include "fovea/lod/live_level.h"

namespace fovea {

namespace {

/// Appends the numbers of a value; 0 where there is none.
void append(std::vector<float>& to, const std::vector<float>& from, ValueId value, std::size_t width) {
  if (!value.valid() || from.empty()) return void(to.insert(to.end(), width, 0.0f));
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(value.index() * width);
  to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
}

/// Takes all steps in turn and gives corners that change another node.
class HierarchyBuilder {
 public:
  HierarchyBuilder(const Model& original, const MultiTessellation& levels)
      : record_(levels.record), live_(original, levels) {
    for (std::size_t m = 0; m < original.meshes.size(); ++m) {
      first_face_.push_back(face_count_);
      face_count_ += static_cast<std::uint32_t>(original.meshes[m].surface.face_count());
      add_mesh(live_.mesh(m));
    }
    removed_by_.assign(face_count_, kInvalid);
    for (std::size_t m = 0; m < original.meshes.size(); ++m) add_vertices(m);
    original_node_ = corner_node_;
  }

  void run(Context& context) {
    constexpr std::size_t kBlock = 1 << 12;
    for (std::size_t s = 0; s < record_.steps.size(); ++s) {
      if (s % kBlock == 0)
        context.advance_or_throw("hierarchy",
                                 static_cast<double>(s) / static_cast<double>(record_.steps.size()));
      take(s);
    }
  }

  VertexHierarchy finish();

 private:
  struct Node {
    std::uint32_t mesh = 0, vertex = 0;
    std::uint32_t parent = kInvalid, step = kInvalid;
  };
  /// A vertex of the level in hand, told by its values.
  struct Wedge {
    std::vector<ValueId> values;  // [#layers]
    std::uint32_t node = 0;
  };

  void add_mesh(const TriMesh& mesh);
  void add_vertices(std::size_t m);
  void take(std::size_t s);
  void forget_followed(std::size_t m, std::vector<std::uint32_t>& corners);
  void mark_faces(std::size_t s);
  bool has_changed(std::size_t s, const Wedge& wedge) const;
  std::uint32_t add_node(std::size_t m, VertexId v, const std::vector<ValueId>& values);
  std::uint32_t node_at(std::size_t m, std::size_t corner, std::vector<Wedge>& wedges);
  void replace(std::uint32_t node, std::uint32_t by, std::size_t s);
  const Wedge* most_alike(const std::vector<ValueId>& values, const std::vector<Wedge>& wedges) const;
  std::vector<ValueId> values_at(std::size_t m, std::size_t corner) const;

  std::span<const ValueWrite> writes(std::size_t s) const {
    const std::size_t begin = s > 0 ? record_.steps[s - 1].writes_end : 0;
    return std::span(record_.writes).subspan(begin, record_.steps[s].writes_end - begin);
  }
  std::uint32_t& node_of(std::size_t m, std::size_t corner) {
    return corner_node_[3 * std::size_t{first_face_[m]} + corner];
  }

  const CollapseRecord& record_;
  LiveLevel live_;
  std::uint32_t face_count_ = 0;
  std::vector<std::uint32_t> first_face_;  // [#meshes]
  std::vector<std::vector<std::vector<std::uint32_t>>>
      corners_;  // [#meshes][#V], corners at each, some of triangles that are gone
  std::vector<LevelVertices> vertices_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> original_node_, corner_node_;  // [#F × 3]
  std::vector<std::uint32_t> removed_by_;                   // [#F]
};

void HierarchyBuilder::add_mesh(const TriMesh& mesh) {
  LevelVertices& vertices = vertices_.emplace_back();
  vertices.position_morphs.resize(mesh.target_count());
  for (const AttributeLayer& layer : mesh.layers) {
    AttributeLayer& empty = vertices.layers.emplace_back();
    empty.semantic = layer.semantic;
    empty.set = layer.set;
    empty.name = layer.name;
    empty.width = layer.width;
    empty.storage = layer.storage;
    empty.morphs.resize(layer.morphs.size());
  }
  auto& corners = corners_.emplace_back(mesh.vertex_count());
  for (std::uint32_t c = 0; c < 3 * mesh.face_count(); ++c)
    corners[mesh.vertex(CornerId{c}).index()].push_back(c);
}

/// The vertices of the original, in the order in which triangles use them.
void HierarchyBuilder::add_vertices(std::size_t m) {
  const TriMesh& mesh = live_.mesh(m);
  std::vector<std::vector<Wedge>> wedges(mesh.vertex_count());
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    std::vector<Wedge>& at_vertex = wedges[mesh.vertex(CornerId{c}).index()];
    corner_node_.push_back(node_at(m, c, at_vertex));
  }
}

std::vector<ValueId> HierarchyBuilder::values_at(std::size_t m, std::size_t corner) const {
  std::vector<ValueId> values;
  for (const AttributeLayer& layer : live_.mesh(m).layers) values.push_back(layer.corner_value[corner]);
  return values;
}

/// The node of a corner's values among those of its vertex, or a new one.
std::uint32_t HierarchyBuilder::node_at(std::size_t m, std::size_t corner, std::vector<Wedge>& wedges) {
  std::vector<ValueId> values = values_at(m, corner);
  for (const Wedge& wedge : wedges) {
    if (wedge.values == values) return wedge.node;
  }
  const std::uint32_t node = add_node(m, live_.mesh(m).vertex(CornerId{corner}), values);
  wedges.push_back({std::move(values), node});
  return node;
}

std::uint32_t HierarchyBuilder::add_node(std::size_t m, VertexId v, const std::vector<ValueId>& values) {
  const TriMesh& mesh = live_.mesh(m);
  LevelVertices& to = vertices_[m];
  nodes_.push_back({static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(to.positions.size())});
  to.positions.push_back(mesh.positions[v.index()]);
  for (std::size_t t = 0; t < to.position_morphs.size(); ++t)
    to.position_morphs[t].push_back(mesh.position_morphs[t][v.index()]);
  for (std::size_t l = 0; l < to.layers.size(); ++l) {
    const AttributeLayer& layer = mesh.layers[l];
    const auto width = static_cast<std::size_t>(layer.width);
    append(to.layers[l].values, layer.values, values[l], width);
    for (std::size_t t = 0; t < layer.morphs.size(); ++t) {
      if (!layer.morphs[t].empty()) append(to.layers[l].morphs[t], layer.morphs[t], values[l], width);
    }
  }
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void HierarchyBuilder::take(std::size_t s) {
  const CollapseStep& step = record_.steps[s];
  mark_faces(s);
  if (step.kind == StepKind::vanish) return live_.set(s, true);
  auto& of_mesh = corners_[step.mesh];
  std::vector<std::uint32_t>& at_removed = of_mesh[step.removed.index()];
  std::vector<std::uint32_t>& at_kept = of_mesh[step.kept.index()];
  // What stays as it is can be used on.
  std::vector<Wedge> wedges;
  for (const std::uint32_t c : at_kept) {
    if (!live_.is_there(step.mesh, FaceId{c / 3})) continue;
    const std::uint32_t node = node_of(step.mesh, c);
    if (std::any_of(wedges.begin(), wedges.end(), [&](const Wedge& w) { return w.node == node; })) continue;
    Wedge wedge{values_at(step.mesh, c), node};
    if (!has_changed(s, wedge)) wedges.push_back(std::move(wedge));
  }
  live_.set(s, true);
  at_kept.insert(at_kept.end(), at_removed.begin(), at_removed.end());
  at_removed = {};
  const auto is_there = [&](std::uint32_t c) { return live_.is_there(step.mesh, FaceId{c / 3}); };
  for (const std::uint32_t c : at_kept) {
    if (!is_there(c)) continue;
    const std::uint32_t now = node_at(step.mesh, c, wedges);
    replace(node_of(step.mesh, c), now, s);
    node_of(step.mesh, c) = now;
  }
  // Those of triangles that are gone follow: without the step that took them they would be here.
  for (const std::uint32_t c : at_kept) {
    const std::uint32_t node = node_of(step.mesh, c);
    if (is_there(c) || nodes_[node].parent != kInvalid) continue;
    if (const Wedge* wedge = most_alike(values_at(step.mesh, c), wedges)) replace(node, wedge->node, s);
  }
  forget_followed(step.mesh, at_kept);
}

/// Of corners whose triangles are gone keeps those whose nodes nothing replaces so far and nobody else will
/// see replaced, one for each.
void HierarchyBuilder::forget_followed(std::size_t m, std::vector<std::uint32_t>& corners) {
  const auto is_there = [&](std::uint32_t c) { return live_.is_there(m, FaceId{c / 3}); };
  const auto gone = std::stable_partition(corners.begin(), corners.end(), is_there);
  std::vector<std::uint32_t> nodes;
  for (auto c = corners.begin(); c != gone; ++c) nodes.push_back(node_of(m, *c));
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  auto kept = gone;
  for (auto c = gone; c != corners.end(); ++c) {
    const std::uint32_t node = node_of(m, *c);
    if (nodes_[node].parent != kInvalid || std::binary_search(nodes.begin(), nodes.end(), node)) continue;
    nodes.insert(std::lower_bound(nodes.begin(), nodes.end(), node), node);
    *kept++ = *c;
  }
  corners.erase(kept, corners.end());
}

/// The wedge in use with most of the values; null without any.
const HierarchyBuilder::Wedge* HierarchyBuilder::most_alike(const std::vector<ValueId>& values,
                                                            const std::vector<Wedge>& wedges) const {
  const Wedge* best = nullptr;
  std::size_t most = 0;
  for (const Wedge& wedge : wedges) {
    if (nodes_[wedge.node].parent != kInvalid) continue;
    std::size_t alike = 1;
    for (std::size_t l = 0; l < values.size(); ++l) alike += wedge.values[l] == values[l];
    if (alike > most) best = &wedge;
    most = std::max(most, alike);
  }
  return best;
}

void HierarchyBuilder::mark_faces(std::size_t s) {
  const CollapseStep& step = record_.steps[s];
  for (std::size_t i = s > 0 ? record_.steps[s - 1].faces_end : 0; i < step.faces_end; ++i)
    removed_by_[first_face_[step.mesh] + record_.removed_faces[i].value] = static_cast<std::uint32_t>(s);
}

/// Whether a step moves the vertex it keeps, or gives new numbers to a value there.
bool HierarchyBuilder::has_changed(std::size_t s, const Wedge& wedge) const {
  if (record_.steps[s].moved) return true;
  const auto changed = writes(s);
  return std::any_of(changed.begin(), changed.end(), [&](const ValueWrite& write) {
    return write.layer == kInvalid || wedge.values[write.layer].value == write.value;
  });
}

void HierarchyBuilder::replace(std::uint32_t node, std::uint32_t by, std::size_t s) {
  if (node == by) return;
  nodes_[node].parent = by;
  nodes_[node].step = static_cast<std::uint32_t>(s);
}

VertexHierarchy HierarchyBuilder::finish() {
  VertexHierarchy result;
  result.vertices = std::move(vertices_);
  result.step_count = record_.steps.size();
  std::vector<std::uint32_t> order(nodes_.size()), number(nodes_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return nodes_[a].step < nodes_[b].step; });
  for (std::uint32_t i = 0; i < order.size(); ++i) number[order[i]] = i;
  for (const std::uint32_t i : order) {
    const Node& node = nodes_[i];
    result.vertex.push_back(node.vertex);
    result.parent.push_back(node.parent == kInvalid ? kInvalid : number[node.parent]);
    result.step.push_back(node.step);
  }
  std::vector<std::uint32_t> height(order.size(), 0);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    result.depth = std::max(result.depth, height[i]);
    if (const std::uint32_t p = result.parent[i]; p != kInvalid)
      height[p] = std::max(height[p], height[i] + 1);
  }

  // Faces part by part.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> faces;
  for (std::uint32_t m = 0; m < first_face_.size(); ++m) {
    const TriMesh& mesh = live_.mesh(m);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
      faces[{m, mesh.face_part[f]}].push_back(first_face_[m] + f);
  }
  for (const auto& [key, of_part] : faces) {
    const auto first = static_cast<std::uint32_t>(result.corners.size());
    for (const std::uint32_t f : of_part) {
      const std::uint32_t* const c = &original_node_[3 * std::size_t{f}];
      result.corners.push_back({number[c[0]], number[c[1]], number[c[2]]});
      result.removed_by.push_back(removed_by_[f]);
    }
    result.parts.push_back({key.first, key.second, first, static_cast<std::uint32_t>(result.corners.size())});
  }
  return result;
}

}  // namespace

VertexHierarchy make_vertex_hierarchy(const Model& original, const MultiTessellation& levels,
                                      Context& context) {
  HierarchyBuilder builder(original, levels);
  builder.run(context);
  return builder.finish();
}

}  // namespace fovea
