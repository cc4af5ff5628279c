#pragma once

#include <array>
#include <span>

#include "fovea/render/scene.h"
#include "fovea/render/screen.h"

// Private to render: what a point of a triangle looks like.

namespace fovea {

/// A point of a triangle: weights of its corners, which add up to 1, and how they change from a pixel to the
/// next to the right and the next below.
struct SurfacePoint {
  std::array<float, 3> weight, dx, dy;
};

/// The footprint that was used last at a point: a material's maps mostly share one.
struct LastLook {
  int look = -1;
  Footprint footprint;
};

/// A triangle of the scene, ready to be looked at in its points. The triangle may reach behind the eye.
class TriangleShader {
 public:
  TriangleShader(const RenderScene& scene, const Projection& projection, int anisotropy,
                 std::uint32_t triangle);

  /// What is at a place of the picture (in pixels from the top left), perspective-correct.
  SurfacePoint at(double x, double y) const;
  std::uint32_t triangle() const { return triangle_; }
  std::uint32_t mesh_number() const { return mesh_number_; }  ///< In the scene.
  const SceneMesh& mesh() const { return *mesh_; }
  FaceId face() const { return face_; }

  /// Base colour as light, with alpha: factor × texture × vertex colour. Calls for the same point share
  /// `last`.
  Rgba base_color(const SurfacePoint& point, LastLook& last) const;
  /// Unit vector, bent by the normal map; seen from behind, it turns with the face to the eye.
  Vec3f normal(const SurfacePoint& point, LastLook& last) const;
  /// Light to the eye under the rig (light_rig.h); the base colour if the material is unlit.
  Rgba lit(const SurfacePoint& point, LastLook& last) const;
  /// 1 at the near end of the scene's sphere, 0 at the far end.
  float depth(const SurfacePoint& point) const;
  /// A number per vertex of the mesh.
  float field(const SurfacePoint& point, std::span<const float> per_vertex) const;
  /// The number, rounded, of the corner with most weight.
  std::uint32_t region(const SurfacePoint& point, std::span<const float> per_vertex) const;

 private:
  Rgba look_up(const SceneTexture& texture, const SurfacePoint& point, LastLook& last) const;
  /// Texture coordinates of the corners; null if the face has none in the set.
  std::array<const float*, 3> uv(int set) const { return set == 0 ? uv_0_ : uv_of_set(set); }
  std::array<const float*, 3> uv_of_set(int set) const;
  Vec3f geometric_normal(const SurfacePoint& point) const;
  Vec3f to_eye(const SurfacePoint& point) const;
  Vec3f map_normal(Vec3f normal, const SurfacePoint& point, LastLook& last) const;
  Vec3f toward(Vec3f normal, Vec3f to_eye) const { return dot(face_normal_, to_eye) < 0 ? -normal : normal; }

  const RenderScene& scene_;
  const Projection& projection_;
  const int anisotropy_;
  const std::uint32_t triangle_;
  std::uint32_t mesh_number_ = 0;
  const SceneMesh* mesh_;
  const SceneMaterial* material_;
  FaceId face_;
  std::array<Vec3d, 3> edges_;  // corner weights before division, linear on the plane of the view
  Vec3d sum_;
  std::array<Vec3f, 3> positions_;
  Vec3f face_normal_;                 // geometric, outward
  std::array<const float*, 3> uv_0_;  // of set 0, which most maps use
};

}  // namespace fovea
