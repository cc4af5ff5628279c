#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fovea/base/options.h"
#include "fovea/model/model.h"

namespace fovea {

/// A model's nodes at one moment.
struct Pose {
  std::vector<Mat4> node_world;                    ///< [#nodes], node to world.
  std::vector<std::vector<double>> morph_weights;  ///< [#nodes][#targets of its mesh]; empty without a mesh.
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// The nodes as the file places them.
Pose rest_pose(const Model& model);

/// The nodes at a time of an animation; before its first key the first, after its last the last. Nodes that
/// it does not move rest. What it does to anything but nodes is left out.
/// Throws Error(unsupported) if there is no such animation.
Pose pose_at(const Model& model, std::size_t animation, double time_s);

/// Which pose of a model is meant: at rest, or at a time of an animation.
struct PoseOptions {
  std::optional<std::int64_t> animation;  ///< Counted from 0; none: at rest.
  std::optional<double> time_s;           ///< 0 without one.
};
OptionList describe(PoseOptions& options);

/// Throws Error(usage) for a time without an animation.
void check(const PoseOptions& options);
/// Throws as `check` and `pose_at`.
Pose pose_of(const Model& model, const PoseOptions& options);

/// Time of an animation's last key, in seconds.
double duration_s(const Animation& animation);

/// A node that shows a mesh.
struct Instance {
  std::size_t mesh = 0, node = 0;
  Mat4 world;  ///< Mesh to world; for skinned meshes the joints place the vertices instead.
};

/// Every showing of every mesh in the default scene (the first if none is named, all nodes without scenes),
/// in the order of nodes.
std::vector<Instance> instances(const Model& model, const Pose& pose);

/// A mesh as an instance shows it, in world space. Triangles and layers are those of the mesh.
struct PosedSurface {
  std::vector<Vec3f> positions;  ///< [#V]
  std::vector<Vec3f> normals;    ///< [#values of the normal layer], unit; empty without one.
  std::vector<Vec3f> tangents;   ///< [#values of the tangent layer], unit; empty without one.
  bool mirrored = false;         ///< Triangles are clockwise seen from outside.
};

/// Applies morph targets, then joints or the instance's transform. O(#V · (#targets + #joints per vertex)).
PosedSurface posed_surface(const Model& model, const Pose& pose, const Instance& instance);

/// Where an instance puts each vertex of its mesh in world space, as a transform of the vertex alone: the
/// joints at `first_corners`, with what morph targets add as a translation before. [#V]; empty if all have
/// the instance's own.
std::vector<Mat4> vertex_transforms(const Model& model, const Pose& pose, const Instance& instance);

/// Takes a normal along, by the cofactor matrix, turned so that it keeps its side when `a` mirrors. Unit.
Vec3f transform_normal(const Mat4& a, Vec3f normal);

/// The first corner at each vertex, whose joints place it; none where there are no triangles. [#V]. O(#F).
std::vector<CornerId> first_corners(const TriMesh& mesh);

/// Where an instance shows the vertices at some corners, in world space: of `first_corners` these are the
/// positions of `posed_surface`. [#corners].
std::vector<Vec3f> posed_points(const Model& model, const Pose& pose, const Instance& instance,
                                std::span<const CornerId> corners);

}  // namespace fovea
