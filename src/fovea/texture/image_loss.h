#pragma once

#include <span>
#include <utility>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/mip_map.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Where pictures look at an image, and how many texels they see at once.
class ImageSights {
 public:
  /// 8,192 points all over the surface (`spread_points`) of `faces`, in pictures in which the model is so
  /// many `pixels` long. Without faces pictures show the image as a whole, from edge to edge. O(#F).
  ImageSights(const Model& model, std::span<const AtlasFace> faces, std::span<const VertexField> field,
              std::vector<double> pixels);

  struct Sight {
    Vec2f uv;
    UvSlopes slopes;  ///< In a picture in which the model is one pixel long.
    double counts = 1;
  };
  /// Looks that are known; their slopes are those of pictures of one pixel of `pixels`.
  ImageSights(std::vector<Sight> sights, std::vector<double> pixels)
      : sights_(std::move(sights)), pixels_(std::move(pixels)) {}
  const std::vector<Sight>& all() const { return sights_; }
  const std::vector<double>& pixels() const { return pixels_; }

 private:
  std::vector<Sight> sights_;
  std::vector<double> pixels_;
};

/// Sizes for ImageSights of a model that will be so many pixels long in pictures: seen aslant, and straight
/// on.
inline std::vector<double> sights_of(double shown_pixels) {
  return {0.75 * shown_pixels, 1.5 * shown_pixels};
}

/// A hundredth of a step of a byte, squared: less is as good as nothing.
inline constexpr double kLeastImageLoss = 1e-4 / (255.0 * 255.0);

/// What pictures lose when an image is another one, in the same place.
class ImageLoss {
 public:
  /// Keeps a reference to the sights. Parallel.
  ImageLoss(const ImageSights& sights, const Image8& image, const ImageUse& use, const Context& context);

  /// [#pixels of the sights] The mean squared difference of what is shown, looked up as GPUs do, with mip
  /// maps: 0 … 1 for each channel. Parallel.
  std::vector<double> of(const Image8& other, const Context& context) const;

 private:
  std::vector<Rgba> looks(const Image8& image, const Context& context) const;

  const ImageSights& sights_;
  TexelMeaning meaning_;
  Sampler sampler_;
  std::vector<Rgba> before_;  // [#sights][#pixels]
};

}  // namespace fovea
