#pragma once

#include <array>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/mip_map.h"
#include "fovea/texture/resize.h"
#include "fovea/texture/texel_origin.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// How coordinates change along two directions on the surface, square to each other, by a unit of length in
/// the scene where a mesh is shown largest: of [#faces], 0 where a triangle has no area.
std::vector<UvSlopes> surface_slopes(const Model& model, std::span<const AtlasFace> faces);

/// Squared differences of pictures in which a model is 512, 1024 and 2048 pixels long.
struct PictureLosses {
  std::array<double, 3> all{};    ///< Of all images, weighted by `loss_weight`.
  std::array<double, 3> color{};  ///< Of colours alone.

  /// The geometric mean; each counts for half a step of a byte at least.
  double mean() const;
  bool is_worse_somewhere(const PictureLosses& than) const;
  void add(const PictureLosses& other, double weight);
};

/// What pictures lose when the texels of an atlas move and its images are others: images are looked up as
/// GPUs do, with mip maps, where the surface faces the viewer.
class SeenLoss {
 public:
  /// `faces` are where they were in `images`; `weights` says how much each place counts, in the space of the
  /// atlas. All are kept by reference but for the images. O(#F + #texels).
  SeenLoss(const Model& model, std::span<const AtlasFace> faces, std::span<const Image8* const> images,
           std::span<const TexelMeaning> meanings, const ImageF& weights);

  /// The mean over the surface, of shown values, 0 … 1. `places` is as large as the weights and says where
  /// they are in the new images, `to` where triangles are. O(#texels of the weights), parallel.
  PictureLosses of(std::span<const AtlasFace> to, const TexelOrigins& places, std::span<const Image8> images,
                   const Context& context) const;
  /// Place by place, of all images: the mean over the pictures; 0 where nothing is drawn.
  ImageF map(std::span<const AtlasFace> to, const TexelOrigins& places, std::span<const Image8> images,
             const Context& context) const;

 private:
  /// Images and how they lie on the surface.
  struct View {
    std::vector<UvSlopes> slopes;  // [#faces]
    std::vector<MipMap> images;
  };
  View view(std::span<const AtlasFace> faces, std::span<const Image8> images) const;
  PictureLosses at(int x, int y, const TexelOrigins& places, const View& now) const;

  const Model& model_;
  std::span<const TexelMeaning> meanings_;
  const ImageF& weights_;
  double diagonal_;  // of the model
  View before_;
};

}  // namespace fovea
