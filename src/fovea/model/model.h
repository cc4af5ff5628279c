#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/accessor.h"
#include "fovea/model/image.h"
#include "fovea/model/material.h"
#include "fovea/model/tri_mesh.h"

namespace fovea {

// A model follows glTF. Every element keeps, as `json`, the text of the glTF object that it was read
// from (empty if it was not): a writer starts from it and refreshes what the typed members cover, so
// that extensions and extras which Fovea does not know go through unchanged. Elements are never
// renumbered; indices inside unknown extensions stay right.

struct Mesh {
  std::string name;
  TriMesh surface;
  std::vector<double> morph_weights;  ///< Default weights [#targets], or empty.
  std::string json;                   ///< Without "primitives" (see Part::json).
};

struct Node {
  std::string name;
  std::vector<int> children;
  int mesh = -1;
  int skin = -1;
  int camera = -1;
  Vec3d translation{0, 0, 0};
  Quat rotation;
  Vec3d scale{1, 1, 1};
  std::optional<Mat4> matrix;         ///< Set if the file gave a matrix instead of the three above.
  std::vector<double> morph_weights;  ///< Overrides the mesh's, or empty.
  /// EXT_mesh_gpu_instancing: the transforms of the instances, applied before the node's own; empty
  /// if the node is not instanced.
  std::vector<Mat4> instances;
  std::string json;

  /// Transform from the node's space to its parent's.
  Mat4 local() const { return matrix ? *matrix : compose(translation, rotation, scale); }
};

struct Scene {
  std::string name;
  std::vector<int> nodes;  ///< Roots.
  std::string json;
};

struct Skin {
  std::string name;
  std::vector<int> joints;  ///< Nodes.
  int skeleton = -1;
  std::optional<Accessor> inverse_bind;  ///< MAT4 per joint; identity if none.
  std::string json;
};

enum class Interpolation { linear, step, cubic_spline };

struct AnimationSampler {
  Accessor input;   ///< Times in seconds, SCALAR float.
  Accessor output;  ///< Values at those times.
  Interpolation interpolation = Interpolation::linear;
  std::string json;
};

struct AnimationChannel {
  int sampler = -1;
  int node = -1;     ///< -1 if an extension names the target.
  std::string path;  ///< "translation", "rotation", "scale", "weights", "pointer".
  std::string json;
};

struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
  std::vector<AnimationSampler> samplers;
  std::string json;
};

struct Camera {
  std::string name;
  bool perspective = true;
  double yfov_rad = 0.8;
  std::optional<double> aspect;
  double xmag = 1, ymag = 1;  ///< Half the width and height if orthographic.
  double znear = 0.01;
  std::optional<double> zfar;
  std::string json;
};

struct Model {
  std::vector<Scene> scenes;
  int default_scene = -1;
  std::vector<Node> nodes;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Sampler> samplers;
  std::vector<EncodedImage> images;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::vector<Camera> cameras;

  std::vector<std::string> extensions_used;
  std::vector<std::string> extensions_required;
  /// The root object as read, without the arrays above and without buffers: asset, extensions
  /// (lights, variants), extras.
  std::string json;
  /// Data that only unknown extensions refer to. Their "accessor" and "bufferView" indices inside
  /// `json` texts count into these two lists.
  std::vector<Accessor> carried_accessors;
  std::vector<std::vector<std::byte>> carried_buffer_views;
};

/// World transform of every node [#nodes] (through the hierarchy; each node has one parent at most).
std::vector<Mat4> world_transforms(const Model& model);
std::vector<Mat4> world_transforms(const std::vector<Node>& nodes);

/// Which nodes belong to the default scene (the first if none is named); all if the model has no scenes.
std::vector<bool> shown_nodes(const Model& model);

/// For each mesh the world transforms of its instances, over all nodes that show it, in node order:
/// of the default scene (the first if none is named), or of all nodes if there are no scenes. A mesh
/// that no node shows has none. A
/// skinned instance is placed by its first joint (joint · inverse bind): glTF ignores the node's own.
std::vector<std::vector<Mat4>> mesh_instances(const Model& model);

/// For each mesh the largest factor on lengths with which an instance shows it; 0 if none does.
std::vector<double> largest_scales(const Model& model);

/// Bounding box of all instances of all meshes in their rest pose, in world space.
Box bounds(const Model& model);

/// Sizes of a model, as `info` and every before/after report print them.
struct ModelCounts {
  std::uint64_t triangles = 0;        ///< Stored: each mesh once.
  std::uint64_t triangles_drawn = 0;  ///< Instances counted as often as they are shown.
  std::uint64_t vertices = 0;         ///< Geometric points.
  std::uint64_t split_vertices = 0;   ///< As a GPU stores them: split at seams and parts.
  std::uint64_t image_bytes = 0;      ///< Encoded.
};
ModelCounts counts(const Model& model);

}  // namespace fovea
