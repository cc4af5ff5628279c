#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/render/projection.h"
#include "fovea/render/scene.h"
#include "fovea/render/screen_vertex.h"
#include "fovea/simplify/collapse_state.h"

namespace fovea {

/// A mesh of the engine as an instance shows it. Its vertices and faces are numbered through over all
/// shown instances.
struct ShownInstance {
  std::uint32_t slot = 0;
  std::uint32_t first_vertex = 0, first_face = 0;  ///< Shown number of the slot's first.
  bool mirrored = false;
  Mat4 world;              ///< Mesh to world ...
  std::vector<Mat4> bent;  ///< ... or, if joints or morph targets bend it, that of each vertex [#V of slot].
};

/// Where views see the vertices of the collapse engine.
class ShownSurface {
 public:
  /// Of the instances in `scene` those of the engine's meshes; `mesh_index` are these in the model, by slot.
  /// `size` is the height of a view in pixels. O(#V · #views), parallel.
  ShownSurface(const CollapseState& state, const Model& model, std::span<const std::size_t> mesh_index,
               const RenderScene& scene, const Pose& pose, std::vector<View> views, int size,
               const Context& context);

  std::size_t view_count() const { return projections_.size(); }
  const View& view(std::size_t v) const { return projections_[v].view(); }
  /// How each slot is shown.
  std::span<const ShownInstance> showings(std::uint32_t slot) const {
    return {showings_.data() + first_showing_[slot], showings_.data() + first_showing_[slot + 1]};
  }
  std::span<const ShownInstance> showings() const { return showings_; }
  std::uint32_t face_count() const { return face_count_; }
  std::size_t bytes() const { return screen_.capacity() * sizeof(ScreenVertex); }
  /// Whether the back of a face is shown too.
  bool is_double_sided(std::uint32_t f) const { return materials_[face_material_[f]].double_sided; }
  std::uint32_t material(std::uint32_t f) const { return face_material_[f]; }
  /// Of its mesh.
  std::uint32_t part(std::uint32_t f) const { return face_part_[f]; }
  std::uint32_t shown_face(const ShownInstance& showing, std::uint32_t f) const {
    return showing.first_face + f - state_.slots[showing.slot].first_face;
  }

  /// A vertex in all views.
  const ScreenVertex* vertex(const ShownInstance& showing, std::uint32_t v) const {
    return screen_.data() + row(showing, v) * view_count();
  }
  /// To world space around a vertex, or between two: `along` is 0 at a and 1 at b.
  Mat4 to_world(const ShownInstance& showing, std::uint32_t a, std::uint32_t b, double along) const;
  const Mat4& to_world(const ShownInstance& showing, std::uint32_t v) const {
    return showing.bent.empty() ? showing.world : showing.bent[v - state_.slots[showing.slot].first_vertex];
  }
  /// A point of the engine in all views, [#views].
  void project(const ShownInstance& showing, Vec3d p, const Mat4& world, ScreenVertex* out) const;
  /// Vertex v moves to p, and bends as what lies between a and b does.
  void move(std::uint32_t v, std::uint32_t a, std::uint32_t b, Vec3d p, double along);

  /// Whether a triangle with these corners shows itself: its front, or its back if that is shown.
  static bool is_seen(const std::array<ScreenVertex, 3>& v, bool double_sided, bool mirrored) {
    for (const ScreenVertex& corner : v) {
      if (corner.x == kUnplaced) return false;
    }
    const std::int64_t area = double_area(v);
    return area != 0 && (double_sided || (area > 0) == mirrored);
  }

 private:
  /// x of a vertex that a view cannot place: triangles at it are not seen.
  static constexpr std::int32_t kUnplaced = std::numeric_limits<std::int32_t>::min();

  std::size_t row(const ShownInstance& showing, std::uint32_t v) const {
    return showing.first_vertex + v - state_.slots[showing.slot].first_vertex;
  }

  const CollapseState& state_;
  std::vector<SceneMaterial> materials_;
  std::vector<std::uint32_t> face_material_, face_part_;  // [#F of the engine]
  std::vector<Projection> projections_;                   // [#views]
  std::vector<ShownInstance> showings_;                   // by slot
  std::vector<std::uint32_t> first_showing_;              // [#slots + 1]
  std::uint32_t face_count_ = 0;                          // shown
  std::vector<ScreenVertex> screen_;                      // [#shown vertices][#views]
};

}  // namespace fovea
