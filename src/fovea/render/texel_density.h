#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"

namespace fovea {

/// How many texels of an image lie along the height of a picture, pixel by pixel: at each the image is laid
/// out over the whole picture as it lies there, along the line where this takes fewest texels. Repeats count.
/// Over all pixels, by 16 steps to an octave.
class TexelDensity {
 public:
  void add(double texels);
  TexelDensity& operator+=(const TexelDensity& other);
  std::uint64_t pixels() const { return pixels_; }
  /// What all but this part of the pixels have, 0 … 1; 0 if there are none.
  double quantile(double part) const;

  bool is_used = false;  ///< By a triangle, seen or not.

 private:
  static constexpr int kSteps = 16, kOctaves = 40;
  std::array<std::uint64_t, kSteps * kOctaves> counts_{};  // from 2^-10 on
  std::uint64_t pixels_ = 0;
};

/// [#images] Over all pixels of pictures `size` pixels high that show a triangle with the image, by any
/// of its materials (variants among them). Where an image shrinks to a line, no number of texels helps, and
/// the pixel does not count. Blended and masked surfaces are taken for opaque. `scene` is of the model and
/// needs no textures. Cost: that of the pictures and O(#pixels · #images of a material). Throws
/// Error(cancelled).
std::vector<TexelDensity> texel_densities(const Model& model, const RenderScene& scene,
                                          std::span<const View> views, int size, const Context& context);

/// The part of the pixels of a picture that may have less than a texel to a pixel.
inline constexpr double kCoarsePixels = 0.1;
/// The scale of the sides of images that no view sees.
inline constexpr double kUnseenScale = 1.0 / 32;

/// What an octave of sizes may be short by, in octaves: 0.84 texels to a pixel at least.
inline constexpr double kSpare = 0.25;

/// [#images] How much smaller the sides of images may be, if pictures are `height` pixels high: all but
/// kCoarsePixels of the pixels keep one texel to a pixel, nearly (kSpare). 1, 1/2, 1/4, ...: GPUs make the
/// same smaller copies of an image, so that pictures see nearly the same. 1 for images that no triangle uses:
/// nothing is known of them.
std::vector<double> needed_scales(std::span<const TexelDensity> densities, double height);

}  // namespace fovea
