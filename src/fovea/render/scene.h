#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/render/view.h"
#include "fovea/surface/pose.h"
#include "fovea/texture/mip_map.h"

namespace fovea {

/// A texture as a material uses it, ready to be looked up.
struct SceneTexture {
  int image = -1;  ///< Index into RenderScene::images.
  int look = -1;   ///< The same for textures that are looked up with the same footprint.
  int uv_set = 0;
  Sampler sampler;
  UvMatrixf matrix;  ///< From KHR_texture_transform.
};

/// A material as the shading reads it.
struct SceneMaterial {
  Rgba base_color;  ///< Light.
  std::optional<SceneTexture> base_color_texture;
  float metallic = 1, roughness = 1;
  std::optional<SceneTexture> metallic_roughness_texture;
  std::optional<SceneTexture> normal_texture;
  float normal_scale = 1;
  std::optional<SceneTexture> occlusion_texture;
  float occlusion_strength = 1;
  Rgba emission{0, 0, 0, 1};
  std::optional<SceneTexture> emissive_texture;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;
};

/// A mesh as one instance shows it.
struct SceneMesh {
  const TriMesh* mesh = nullptr;
  std::uint32_t mesh_index = 0;      ///< In the model.
  std::uint32_t first_triangle = 0;  ///< Number of its first triangle in the scene.
  PosedSurface surface;
  std::vector<const AttributeLayer*> uv;  ///< [set]
  const AttributeLayer *normal = nullptr, *tangent = nullptr, *color = nullptr;
  std::vector<std::uint32_t> part_material;  ///< [#parts], into RenderScene::materials.
};

/// A decoded image with where it comes from. Scenes of models with the same images can share it.
struct SceneImage {
  const EncodedImage* image = nullptr;
  ColorEncoding encoding = ColorEncoding::srgb;
  std::shared_ptr<const MipMap> map;  ///< Without levels if it could not be decoded.
};

/// What a picture is drawn of: the instances of a model in a pose, with decoded textures. Triangles are
/// numbered through: instance by instance, each in the order of its mesh. Refers to the model, which must
/// outlive it.
struct RenderScene {
  std::vector<SceneMesh> meshes;
  std::vector<SceneMaterial> materials;  ///< The model's, then glTF's default one.
  std::vector<SceneImage> images;        ///< Those that materials use, per encoding.
  std::uint64_t triangle_count = 0;
  Sphere sphere;  ///< Around the centre of the box of all positions.
};

/// Which textures of materials are decoded; the others count as absent.
enum class SceneTextures {
  all,
  base_and_finish,  ///< Base colour, metalness and roughness.
  none,
};

/// Poses all instances and decodes the images in parallel. Images that cannot be decoded (KTX2, damaged)
/// count as absent and are reported ("image-not-shown"). Images that `other` has decoded already are shared
/// with it. Throws Error(limit) beyond 2³² − 1 triangles.
RenderScene make_render_scene(const Model& model, const Pose& pose, Context& context,
                              const RenderScene* other = nullptr,
                              SceneTextures textures = SceneTextures::all);

/// A mesh alone as it lies in its own space, grey, both sides of its triangles shown. Refers to the mesh,
/// which must outlive it.
RenderScene make_render_scene(const TriMesh& mesh);

/// What the model's own cameras see, node by node. One whose aspect ratio is not given is taken for a wide
/// screen's, 16 : 9.
std::vector<View> camera_views(const Model& model, const Pose& pose);

/// The views of a set onto a model in a pose; around the sphere, unless they are its own cameras. Of cameras
/// that animations move, `ViewOptions::count` places along each path, if the pose is that at rest.
/// Throws Error(unsupported) if these are asked for and there are none.
std::vector<View> views_of(const ViewOptions& options, const Model& model, const Pose& pose,
                           const Sphere& sphere);

/// Where a triangle of the scene comes from.
struct TriangleOrigin {
  std::uint32_t mesh = 0;  ///< Index into RenderScene::meshes.
  FaceId face;
};
TriangleOrigin origin(const RenderScene& scene, std::uint32_t triangle);

}  // namespace fovea
