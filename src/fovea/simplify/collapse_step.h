#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/simplify/collapse_queue.h"
#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/edge_cost.h"
#include "fovea/simplify/legality.h"
#include "fovea/simplify/record.h"
#include "fovea/simplify/value_merge.h"
#include "fovea/simplify/vertex_notes.h"

namespace fovea {

class ViewMetric;

/// Carries out what the collapse engine has decided: rewires triangles, merges quadrics and values, tells
/// `cost`, `views` (if any) and the queue, which edges that are gone leave, and writes the record. All that
/// it is made of must outlive it. `error` is the largest of the steps that the record has already.
class CollapseStepper {
 public:
  CollapseStepper(CollapseState& state, EdgeCost& cost, const Legality& legality, ValueMerge& merge,
                  CollapseQueue& queue, ViewMetric* views, CollapseRecord& record, double error)
      : state_(state),
        mesh_(state.mesh),
        cost_(cost),
        legality_(legality),
        merge_(merge),
        queue_(queue),
        views_(views),
        record_(record),
        error_(error) {}

  /// Collapses edge e to p, as `merge` has planned it and `legality` looked at it. Returns the vertex that is
  /// left. O(one-rings).
  std::uint32_t collapse(std::uint32_t e, Vec3d p, double error);
  /// Drops faces, all that are left of a component.
  void vanish(std::span<const std::uint32_t> faces, double error);
  /// The largest error so far.
  double error() const { return error_; }

 private:
  void note_twins(std::uint32_t a, std::uint32_t b);
  template <class KeptFor>
  void give_ring(std::uint32_t a, std::uint32_t b, KeptFor&& kept_for);
  void merge_edges(std::uint32_t a, std::uint32_t b);
  void merge_twins(std::uint32_t a, std::uint32_t b);
  void drop_coincident_faces();
  void leave_edge(std::uint32_t e, std::uint32_t half_edge);
  void drop_face(std::uint32_t f);
  void retire_values(std::uint32_t a, std::uint32_t b);
  void look_at_values(std::uint32_t v);
  void finish_step(CollapseStep step, double error);

  CollapseState& state_;
  CollapseMesh& mesh_;
  EdgeCost& cost_;
  const Legality& legality_;
  ValueMerge& merge_;
  CollapseQueue& queue_;
  ViewMetric* const views_;
  CollapseRecord& record_;
  double error_;

  /// A corner of a face that was dropped, at a vertex of several values.
  struct DroppedCorner {
    std::uint32_t corner, vertex;
  };
  std::vector<DroppedCorner> dropped_;
  /// Edges of a dropped face that become one.
  struct TwinEdges {
    std::uint32_t at_a, at_b;
  };
  std::vector<TwinEdges> twins_;
  // Scratch:
  VertexNotes notes_;
};

}  // namespace fovea
