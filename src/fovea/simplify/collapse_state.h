#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/line_allocator.h"
#include "fovea/base/math.h"
#include "fovea/model/field.h"
#include "fovea/model/tri_mesh.h"
#include "fovea/simplify/collapse_mesh.h"
#include "fovea/simplify/quadric.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

/// What happens to the values of a channel when vertices merge.
enum class ChannelKind {
  fitted,        ///< Set to the best for the new position by the attribute's quadric.
  interpolated,  ///< Mixed along the edge (tangents, and attributes of weight zero).
  nearest,       ///< Taken from the nearer end (custom attributes: ids do not mix).
  skin,          ///< Influences of all JOINTS_n and WEIGHTS_n mixed, the strongest kept.
};

/// A piece of a layer's values inside a channel's values.
struct ChannelSlice {
  std::uint32_t layer = kInvalid;  ///< Index into the mesh's layers; kInvalid: position morphs.
  int offset = 0;                  ///< Of its first float in a channel value.
  int width = 0;                   ///< Floats: layer width × (1 + morphs), or 3 × targets.
  Semantic semantic = Semantic::custom;
};

/// What one channel has for each item of a table; what the channels have for the same item lies together,
/// since it is read together.
class Column {
 public:
  Column() = default;
  Column(std::uint32_t* first, std::size_t channels) : first_(first), channels_(channels) {}
  std::uint32_t& operator[](std::size_t item) { return first_[item * channels_]; }
  const std::uint32_t& operator[](std::size_t item) const { return first_[item * channels_]; }

 private:
  std::uint32_t* first_ = nullptr;
  std::size_t channels_ = 0;
};

/// An attribute of all meshes together: the values and corner maps of the layers, in one array each, with
/// what the engine needs to know to fit them. Values are in the order in which triangles use them.
struct Channel {
  ChannelKind kind = ChannelKind::fitted;
  Semantic semantic = Semantic::custom;
  int set = 0;
  std::string name;
  bool is_position_morph = false;
  int fit_width = 0;  ///< Leading floats of a value that are fitted; the others are interpolated.
  int width = 0;      ///< Floats per value.
  std::size_t quadric_size = 0, stride = 0;  ///< Floats of a record, and of the quadric in it.
  Column corner_value;                       ///< [#F × 3] or kInvalid.
  Column single;                             ///< [#V]: the vertex's only value, kMany or kInvalid.
  /// Of each value its quadric, if it is fitted, then its numbers in the layer's units: what is read together
  /// lies together, that of normals on one cache line. [#values × stride]
  std::vector<float, LineAllocator<float>> records;
  std::vector<std::vector<ChannelSlice>> slices;  ///< [#meshes]; empty where the mesh lacks it.
  std::vector<ValueId> layer_value;               ///< [#values], of its mesh's layers.
  std::vector<double> scale;  ///< [#meshes], from the layer's units to lengths of the engine.

  static constexpr std::uint32_t kMany = kInvalid - 1;
  float* value(std::uint32_t id) { return records.data() + id * stride + quadric_size; }
  const float* value(std::uint32_t id) const { return records.data() + id * stride + quadric_size; }
  float* value_quadric(std::uint32_t id) { return records.data() + id * stride; }
  const float* value_quadric(std::uint32_t id) const { return records.data() + id * stride; }
  bool is_uv() const { return semantic == Semantic::uv; }
};

/// A mesh's place in the arrays of the engine, and its frame: engine = (local − center) · scale.
struct MeshSlot {
  std::uint32_t first_vertex = 0, first_face = 0;
  Vec3d center;
  double scale = 1;

  Vec3d to_engine(Vec3f p) const { return (Vec3d(p) - center) * scale; }
  Vec3f to_local(Vec3d p) const { return Vec3f(p / scale + center); }
  /// The same to calculate on with: what a file will have.
  Vec3d to_local_exact(Vec3d p) const { return in_single_precision(p / scale + center); }
};

/// A whole component as a candidate to go.
struct VanishCandidate {
  double cost = 0;
  double error = 0;  ///< Half the diagonal of its box.
};

/// All that the engine works on: the meshes of a scene in one set of arrays, each in a local order
/// (surface/local_order.h), lengths in units of the scene's diagonal so that costs of different meshes
/// compare.
struct CollapseState {
  CollapseState() = default;
  CollapseState(CollapseState&&) = default;  // not copied: channels point into `columns`
  CollapseState& operator=(CollapseState&&) = default;

  CollapseMesh mesh;
  std::vector<Channel> channels;
  std::vector<std::uint32_t> columns;   // of the channels: [#F × 3][#channels], then [#V][#channels]
  std::vector<MeshSlot> slots;          // [#meshes]
  std::vector<VertexId> mesh_vertex;    // [#V], in its mesh
  std::vector<FaceId> mesh_face;        // [#F], in its mesh
  FaceComponents components;            // without their faces if there is only one
  std::vector<VanishCandidate> vanish;  // [#components]

  /// Faces of a mesh, those that are gone among them.
  std::uint32_t face_count(std::size_t slot) const {
    const auto all = static_cast<std::uint32_t>(mesh_face.size());
    return (slot + 1 < slots.size() ? slots[slot + 1].first_face : all) - slots[slot].first_face;
  }
  std::uint32_t slot_of_vertex(std::uint32_t v) const {
    return slots.size() == 1 ? 0 : find_slot(v, &MeshSlot::first_vertex);
  }
  std::uint32_t slot_of_face(std::uint32_t f) const {
    return slots.size() == 1 ? 0 : find_slot(f, &MeshSlot::first_face);
  }

 private:
  std::uint32_t find_slot(std::uint32_t item, std::uint32_t MeshSlot::*first) const;
};

/// Lays out `meshes` (with their scales in scene units, importance fields, which may be empty, and sorted
/// lists of faces that are left out, if there are any) and computes the initial quadrics. `diagonal` is the
/// scene's. O(#F · #layers), parallel.
CollapseState make_collapse_state(std::span<const TriMesh* const> meshes, std::span<const double> scales,
                                  std::span<const VertexField* const> importance,
                                  std::span<const std::vector<FaceId>* const> left_out, double diagonal,
                                  const SimplifyOptions& options, const Context& context);

}  // namespace fovea
