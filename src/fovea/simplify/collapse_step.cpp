#include "fovea/simplify/collapse_step.h"

#include <algorithm>
#include <utility>

#include "fovea/simplify/view_metric.h"

namespace fovea {

std::uint32_t CollapseStepper::collapse(std::uint32_t e, Vec3d p, double error) {
  auto [a, b] = mesh_.edges[e].ends;
  if (mesh_.vertices[a].locked || (!mesh_.vertices[b].locked && p == mesh_.position(a))) {
    std::swap(a, b);
    merge_.plan(e, a, b, p);
  }
  const std::uint32_t m = state_.slot_of_vertex(a);
  const bool moved = !(p == mesh_.position(b));

  if (views_ != nullptr) views_->before_collapse(a, b, p);
  merge_.apply(a, b, m, record_);
  dropped_.clear();
  note_twins(a, b);
  for (const std::uint32_t f : legality_.shared_faces(a)) drop_face(f);
  if (legality_.is_plain()) {
    merge_twins(a, b);
  } else {
    merge_edges(a, b);
  }
  drop_coincident_faces();

  const Quadric q = mesh_.quadric(a) + mesh_.quadric(b);
  mesh_.vertices[b].position = Vec3f(p);
  mesh_.set_quadric(b, q);
  if (mesh_.vertices[a].locked) mesh_.vertices[b].locked = 1;
  if (mesh_.vertices[a].refused) mesh_.vertices[b].refused = 1;
  retire_values(a, b);
  cost_.forget(a);
  look_at_values(b);
  if (views_ != nullptr) views_->after_collapse(a, b);

  CollapseStep step;
  step.mesh = m;
  step.removed = state_.mesh_vertex[a];
  step.kept = state_.mesh_vertex[b];
  step.moved = moved;
  if (moved) step.position = state_.slots[m].to_local(p);
  finish_step(step, error);
  return b;
}

void CollapseStepper::vanish(std::span<const std::uint32_t> faces, double error) {
  if (views_ != nullptr) views_->lose(faces);
  CollapseStep step;
  step.kind = StepKind::vanish;
  step.mesh = state_.slot_of_face(faces.front());
  for (const std::uint32_t f : faces) drop_face(f);
  finish_step(step, error);
}

/// A half-edge leaves edge e; with the last the edge goes.
void CollapseStepper::leave_edge(std::uint32_t e, std::uint32_t half_edge) {
  mesh_.edges[e].remove(half_edge);
  if (!mesh_.edge_alive(e)) queue_.remove(e);
}

void CollapseStepper::drop_face(std::uint32_t f) {
  for (std::uint32_t c = 3 * f; c < 3 * f + 3; ++c) {
    if (cost_.has_many(mesh_.vertex(c))) dropped_.push_back({c, mesh_.vertex(c)});
    leave_edge(mesh_.edge(c), c);
    mesh_.unlink_corner(c);
  }
  mesh_.kill_face(f);
  record_.removed_faces.push_back(state_.mesh_face[f]);
}

/// Notes which edges of the faces between a and b become one.
void CollapseStepper::note_twins(std::uint32_t a, std::uint32_t b) {
  twins_.clear();
  for (const std::uint32_t f : legality_.shared_faces(a)) {
    const CollapseFace& face = mesh_.faces[f];
    const auto k = static_cast<std::uint32_t>(std::find(face.vertex.begin(), face.vertex.end(), a) -
                                              face.vertex.begin());
    const std::uint32_t n = CollapseMesh::after(k), p = CollapseMesh::before(k);
    // Of the other two corners one is b's, and the edge between them is its edge to the other.
    twins_.push_back({face.edge[face.vertex[n] == b ? p : k], face.edge[n]});
  }
}

/// Gives a's triangles and edges to b. Of an edge e to w `kept_for(e, w)` says which edge it becomes: one of
/// b's, or itself.
template <class KeptFor>
void CollapseStepper::give_ring(std::uint32_t a, std::uint32_t b, KeptFor&& kept_for) {
  const auto take_over = [&](std::uint32_t half_edge, std::uint32_t w) {
    const std::uint32_t e = mesh_.edge(half_edge), kept = kept_for(e, w);
    if (kept == e) {
      mesh_.edges[e].ends = {b, w};
      return;
    }
    mesh_.edge(half_edge) = kept;
    mesh_.edges[kept].add(half_edge);
    leave_edge(e, half_edge);
  };
  mesh_.for_ring(a, [&](std::uint32_t c) {
    const CornerView at_c = mesh_.view(c);
    take_over(c, at_c.next);
    take_over(CollapseMesh::previous(c), at_c.previous);
  });
  mesh_.join_rings(a, b);
}

/// Gives a's triangles and edges to b, where only edges of the faces between them become one.
void CollapseStepper::merge_twins(std::uint32_t a, std::uint32_t b) {
  std::erase_if(twins_, [&](const TwinEdges& twins) { return !mesh_.edge_alive(twins.at_b); });
  give_ring(a, b, [&](std::uint32_t e, std::uint32_t) {
    std::uint32_t kept = e;
    for (const TwinEdges& twins : twins_) kept = twins.at_a == e ? twins.at_b : kept;
    return kept;
  });
}

/// Gives a's triangles and edges to b; two edges to the same neighbour become one.
void CollapseStepper::merge_edges(std::uint32_t a, std::uint32_t b) {
  // Of a neighbour of b is noted its edge to b, plus one.
  notes_.clear(2 * (mesh_.ring(a).size() + mesh_.ring(b).size()));
  mesh_.for_ring(b, [&](std::uint32_t c) {
    const CornerView at_c = mesh_.view(c);
    notes_[notes_.place(at_c.next)] = at_c.to_next + 1;
    notes_[notes_.place(at_c.previous)] = at_c.to_previous + 1;
  });
  give_ring(a, b, [&](std::uint32_t e, std::uint32_t w) {
    std::uint32_t& note = notes_[notes_.place(w)];
    if (note == 0) note = e + 1;
    return note - 1;
  });
}

/// After a collapse that pinches the surface triangles from either end can lie on each other. Back to back
/// they enclose nothing: both go. Two that face the same way stay: without one of them the triangles beside
/// it would end at nothing, now or when what is left goes. What lay on each other before stays so.
void CollapseStepper::drop_coincident_faces() {
  legality_.for_coincident([&](std::uint32_t c, std::uint32_t d) {
    if (!mesh_.face_alive(c / 3) || !mesh_.face_alive(d / 3)) return;
    drop_face(d / 3);
    drop_face(c / 3);
  });
}

/// Values that lost their last triangle (a chart that ends) stay in the error as they were: what they make
/// up for goes into the quadric of their vertex for good.
void CollapseStepper::retire_values(std::uint32_t a, std::uint32_t b) {
  for (const auto& [c, vertex] : dropped_) {
    const std::uint32_t v = vertex == a ? b : vertex;
    const auto ring = mesh_.ring(v);
    bool retired = false;
    for (Channel& channel : state_.channels) {
      const std::uint32_t value = channel.corner_value[c];
      if (channel.kind != ChannelKind::fitted || value == kInvalid) continue;
      bool is_used = false;
      for (const std::uint32_t d : ring) is_used |= channel.corner_value[d] == value;
      if (is_used) continue;
      mesh_.set_quadric(v, mesh_.quadric(v) + cost_.separate(channel, v, value));
      std::fill_n(channel.value_quadric(value), attribute_stride(channel.fit_width), 0.0f);
      retired = true;
    }
    if (retired && v != b) look_at_values(v);
  }
}

/// To be called when the values or triangles at v have changed.
void CollapseStepper::look_at_values(std::uint32_t v) {
  merge_.update_singles(v);
  cost_.refresh(v);
}

void CollapseStepper::finish_step(CollapseStep step, double error) {
  error_ = std::max(error_, error);
  step.error_rel = static_cast<float>(error_);
  step.faces_end = static_cast<std::uint32_t>(record_.removed_faces.size());
  step.joins_end = static_cast<std::uint32_t>(record_.joins.size());
  step.writes_end = static_cast<std::uint32_t>(record_.writes.size());
  record_.steps.push_back(step);
}

}  // namespace fovea
