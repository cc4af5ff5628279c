#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/field.h"
#include "fovea/model/image.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"

namespace fovea {

/// What a picture shows of a surface.
enum class Pass {
  base_color,  ///< Base colour without any light on it.
  lit,         ///< Metallic-roughness material with all its maps, under the fixed rig (light_rig.h).
  normal,      ///< World normal with the normal map; −1 … 1 as 0 … 255.
  depth,       ///< White at the near end of the scene's sphere, black at the far end.
  triangle,    ///< A colour for every triangle,
  mesh,        ///< for every mesh of the scene,
  part,        ///< for every part of a mesh (its materials).
  field,       ///< A number per vertex as heat.
  region,      ///< A colour for every region, numbered per vertex: that of the nearest corner.
};

struct RenderOptions {
  Pass pass = Pass::lit;
  std::int64_t width = 512, height = 512;  ///< Pixels, 1 … 32768.
  std::int64_t samples = 2;                ///< Along each axis of a pixel: 1 … 8.
  std::int64_t anisotropy = 1;             ///< Most looks into a texture along its longer slope.
  std::array<std::uint8_t, 3> background{128, 128, 128};  ///< Display values.
};

OptionList describe(RenderOptions& options);

/// A picture of a scene.
struct Picture {
  Image8 color;     ///< RGB display values, over the background.
  Image8 coverage;  ///< One channel: how much of each pixel the model covers.
};

/// Draws the scene. Edges are smooth: every pixel has samples² places where its nearest surface is looked
/// for; each surface found is shaded once, in the middle of its samples, and light is averaged. Blended
/// surfaces are laid over what is behind them, far to near, per sample. `fields` are, for Pass::field, a
/// number in [0, 1] per vertex of each of the model's meshes [#meshes], for Pass::region the number of its
/// region (rounded); meshes with an empty one are grey.
///
/// The same bits for any number of threads and on any machine with IEEE arithmetic.
/// O(#V + #F + #samples · depth of what is drawn over).
Picture render(const RenderScene& scene, const View& view, const RenderOptions& options,
               const Context& context, std::span<const VertexField> fields = {});

/// The same in several passes, for which what is visible is found once: one picture for each of `passes`,
/// whatever `options` say.
std::vector<Picture> render_passes(const RenderScene& scene, const View& view, std::span<const Pass> passes,
                                   const RenderOptions& options, const Context& context,
                                   std::span<const VertexField> fields = {});

/// One picture per view, views in parallel. Throws Error(cancelled).
std::vector<Picture> render_views(const RenderScene& scene, std::span<const View> views,
                                  const RenderOptions& options, const Context& context,
                                  std::span<const VertexField> fields = {});

/// What is nearest at the middle of each pixel, blended surfaces counted as opaque.
struct VisibleSurface {
  int width = 0, height = 0;
  std::vector<std::uint32_t> triangle;  ///< [height × width], of the scene; kInvalid for the background.
  std::vector<float> distance;          ///< [height × width], in front of the eye's plane; infinite there.
};
VisibleSurface visible_surface(const RenderScene& scene, const View& view, int width, int height,
                               const Context& context);

/// A colour for a number in [0, 1], as display values: dark blue over green to yellow, of evenly rising
/// lightness (a polynomial through viridis).
std::array<std::uint8_t, 3> heat_color(float x);

}  // namespace fovea
