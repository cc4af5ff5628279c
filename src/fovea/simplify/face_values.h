#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/wide.h"
#include "fovea/render/corner_planes.h"
#include "fovea/render/display_texture.h"
#include "fovea/render/light_table.h"
#include "fovea/render/scene.h"
#include "fovea/simplify/shown_surface.h"
#include "fovea/simplify/value_merge.h"
#include "fovea/texture/regions.h"

namespace fovea {

/// What a view notes of a surface in a pixel.
enum class PixelContent {
  color,   ///< Base colour, as packed display values.
  lit,     ///< Base colour under Fovea's rig, diffuse: shape shows in it.
  region,  ///< The number of the texture's region, 1 and up.
  face,    ///< The number of the face, 1 and up.
};

/// A face as it looks: what its corners have for the content.
struct FaceLook {
  const DisplayTexture* texture = nullptr;  ///< None: `color` all over.
  std::array<Float4, 3> uv;                 ///< Where a texture is looked up, transformed: the first two.
  float texel_area = 0;                     ///< Twice the face's area in texels of the whole image.
  PackedColor color = 0;                    ///< Of the material's factor.
  bool is_tinted = false, is_lit = false;
  std::array<Float4, 3> tint;            ///< Vertex colours, as display values 0 … 1: the first three.
  std::array<Vec3f, 3> normal;           ///< In the world.
  const PartRegions* regions = nullptr;  ///< With content `region`, and what these are asked with:
  FaceId face;                           ///< of the mesh,
  bool has_region_uv = false;
  std::array<Float4, 3> region_uv;  ///< as the mesh has them.
  std::uint32_t number = 0;         ///< Of the shown face, from 1.
  std::uint32_t material = 0;
};

/// A collapse as the faces around it see it.
struct PlannedCollapse {
  std::uint32_t a = kInvalid, b = kInvalid;
  Vec3d position;                     ///< Of the merged vertex.
  const ValueMerge* merge = nullptr;  ///< Has planned it.
  Mat4 world;                         ///< Mesh to world at the merged vertex.
};

/// Says what faces of the collapse engine show in pixels, as they are or as a planned collapse would leave
/// them. Refers to all that it was made of.
class FaceValues {
 public:
  /// `regions` is for content `region` alone, else null; `mesh_index` are the meshes of the engine in the
  /// model.
  FaceValues(const CollapseState& state, const ShownSurface& shown, const RenderScene& scene,
             PixelContent content, int view_size, const ModelRegions* regions,
             std::span<const std::size_t> mesh_index, const Context& context);

  /// What a pixel without any surface has.
  std::uint32_t background() const;
  /// Of regions and faces: one more than the largest number.
  std::size_t value_count() const;
  /// Whether face f may have holes, by the alpha of its material.
  bool has_holes(std::uint32_t f) const { return materials_[shown_.material(f)].cutoff > 0; }

  /// Face f as it is, or as a planned collapse leaves it.
  FaceLook look(const ShownInstance& showing, std::uint32_t f,
                const PlannedCollapse* planned = nullptr) const;

  /// A face in a view, ready to be looked at.
  class Shading {
   public:
    Shading(const FaceValues& values, const FaceLook& look, const std::array<ScreenVertex, 3>& v,
            std::size_t view, bool mirrored);
    /// What the pixels x + 2¹⁶ · y show, FragmentLists::kHole where there is a hole. `out` [#pixels].
    void at(std::span<const std::uint32_t> pixels, std::uint32_t* out) const;
    /// The same for the pixels [x0, x1) of a row.
    void row(int y, int x0, int x1, std::uint32_t* out) const;

   private:
    struct Samples;
    static void on_surface(const CornerPlanes::Plane& plane, int number, const Samples& at, WideFloats& out);
    void color_at(const Samples& at, WideWords& out) const;
    void region_texel(const Samples& at, WideWords& out) const;
    void shade(const Samples& at, WideWords& out) const;
    void light_up(const Samples& at, WideWords& color) const;

    const FaceValues& values_;
    const FaceLook& look_;
    CornerPlanes::Plane normal_;  // turned to the side that is seen; the last is 1
    CornerPlanes::Plane uv_, tint_, region_uv_;
    std::size_t level_ = 0;
    const LightTable* light_ = nullptr;
    std::uint32_t cutoff_ = 0;
  };

 private:
  struct MaterialLook {
    int texture = -1;  // into textures_
    int channel = -1;  // of the state: the texture coordinates
    UvMatrixf matrix;
    PackedColor color = 0;
    std::uint32_t cutoff = 0;  // alpha below which there is a hole, 0 … 255
    bool unlit = false;
    std::size_t finish = 0;  // which of the light tables of a view
  };
  /// Metallic and roughness, rounded so that materials share tables.
  struct Finish {
    int metallic, roughness;
    friend bool operator==(const Finish&, const Finish&) = default;
  };
  bool corner_values(int channel, std::uint32_t f, const PlannedCollapse* planned,
                     std::array<const float*, 3>& values) const;
  void set_normals(FaceLook& look, const ShownInstance& showing, std::uint32_t f,
                   const PlannedCollapse* planned) const;
  void set_region(FaceLook& look, std::uint32_t slot, std::uint32_t f, const PlannedCollapse* planned) const;
  void make_lights(const RenderScene& scene, const Context& context);
  int add_texture(const RenderScene& scene, const SceneTexture& texture, Rgba factor);

  const CollapseState& state_;
  const ShownSurface& shown_;
  const PixelContent content_;
  const int view_size_;
  const ModelRegions* const regions_;
  std::vector<std::size_t> mesh_index_;
  std::vector<MaterialLook> materials_;
  std::vector<Finish> finishes_;
  std::vector<LightTable> lights_;  // [#views][#finishes], with content `lit`
  std::vector<DisplayTexture> textures_;
  struct TextureKey {
    int image;
    Rgba factor;
    Wrap wrap_u, wrap_v;
    friend bool operator==(const TextureKey&, const TextureKey&) = default;
  };
  std::vector<TextureKey> keys_;  // [#textures]
  int normal_channel_ = -1, color_channel_ = -1;
};

}  // namespace fovea
