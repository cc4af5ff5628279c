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
#include "fovea/texture/texel_origin.h"
#include "fovea/texture/texel_scan.h"

// Shared inside Fovea, not installed.

namespace fovea {

inline constexpr std::size_t kPictureSizes = 3;
/// Differences of pictures in which a model is 512, 1024 and 2048 pixels long, of shown values, 0 … 1.
struct PictureLosses {
  std::array<double, kPictureSizes>
      all{};  ///< Squared, of all images, weighted by `loss_weight`: as PSNR counts.
  std::array<double, kPictureSizes> color{};     ///< Of colours alone; as `all` without such.
  std::array<double, kPictureSizes> distance{};  ///< Of colours, not squared: nearer to what FLIP counts.

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
  /// corners by `turns` (`tangent_turns`; or none at all). Parallel.
  PictureLosses of(std::span<const AtlasFace> to, std::span<const std::array<float, 3>> turns,
                   std::span<const Image8> images, const Context& context) const;
  /// Texel by texel, the mean over the pictures if only the images change; 0 where nothing is drawn.
  /// `places` says which triangle is where. O(#texels of `places`), parallel.
  ImageF map(const TexelOrigins& places, std::span<const Image8> images, const Context& context) const;

 private:
  struct Point {
    std::uint32_t face;
    std::array<double, 3> weights;  // of its corners
    double counts;
  };
  /// Images and how they lie on the surface.
  struct View {
    std::vector<UvSlopes> slopes;  // [#faces]
    std::vector<MipMap> images;
  };
  void spread_points(std::span<const VertexField> field);
  View view(std::span<const AtlasFace> faces, std::span<const Image8> images) const;
  PictureLosses at(std::uint32_t face, Vec2f was, Vec2f is, float turn, const View& now) const;

  const Model& model_;
  std::vector<AtlasFace> faces_;
  std::vector<TexelMeaning> meanings_;
  double diagonal_;  // of the model
  View before_;
  std::vector<Point> points_;
  Sampler sampler_ = clamping_sampler();
};

}  // namespace fovea
