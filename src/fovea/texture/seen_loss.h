#pragma once

#include <array>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/mip_map.h"
#include "fovea/texture/resize.h"
#include "fovea/texture/seen_points.h"
#include "fovea/texture/texel_origin.h"
#include "fovea/texture/texel_scan.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Differences of pictures of `kPictureSizes`, of shown values, 0 … 1.
struct PictureLosses {
  using Losses = std::array<double, kPictureSizes.size()>;
  Losses all{};       ///< Squared, of all images, weighted by `loss_weight`: as PSNR counts.
  Losses color{};     ///< Of colours alone; as `all` without such.
  Losses distance{};  ///< Of colours, not squared: nearer to what FLIP counts.

  /// The geometric mean of the first two; each counts for half a step of a byte at least.
  double mean() const;
  /// All are below that.
  bool is_nothing() const;
  bool is_worse_somewhere(const PictureLosses& than) const;
  void add(const PictureLosses& other, double weight);
};

/// What pictures lose when the texels of an atlas move and its images are others: at points all over the
/// surface, which count alike but for the field, images are looked up as GPUs do, with mip maps, as if the
/// surface were seen at the same angle everywhere. So triangles count that cover no texel's centre, or none
/// at all.
class SeenLoss {
 public:
  /// `faces` are where they are in `images`, the field as for `texture_importance`. Keeps a reference to the
  /// model. O(#F).
  SeenLoss(const Model& model, std::vector<AtlasFace> faces, std::vector<MipMap> images,
           std::vector<TexelMeaning> meanings, std::span<const VertexField> field);

  const MipMap& image(std::size_t i) const { return before_.images[i]; }

  /// The mean over the surface with triangles and images like these, normal maps among them that turn at
  /// corners by `turns` (`tangent_turns`; or none at all). Images without texels are left out, so that what
  /// is lost by all is no less. Parallel.
  PictureLosses of(std::span<const AtlasFace> to, std::span<const std::array<float, 3>> turns,
                   std::span<const Image8> images, const Context& context) const;
  /// Texel by texel, the mean over the pictures if only the images change; 0 where nothing is drawn.
  /// `places` says which triangle is where. O(#texels of `places`), parallel.
  ImageF map(const TexelOrigins& places, std::span<const Image8> images, const Context& context) const;

 private:
  /// Images and how they lie on the surface.
  struct View {
    std::vector<UvSlopes> slopes;  // [#faces] `picture_slopes`
    std::vector<MipMap> images;
    /// Images of one size, and of one before, which are looked up alike.
    std::vector<std::vector<std::size_t>> alike;
  };
  View view(std::span<const AtlasFace> faces, std::span<const Image8> images) const;
  PictureLosses at(std::uint32_t face, Vec2f was, Vec2f is, float turn, const View& now) const;

  const Model& model_;
  std::vector<AtlasFace> faces_;
  std::vector<TexelMeaning> meanings_;
  View before_;
  std::vector<SurfacePoint> points_;
  Sampler sampler_ = clamping_sampler();
};

}  // namespace fovea
