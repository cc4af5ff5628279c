#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/model/image.h"
#include "fovea/model/material.h"
#include "fovea/model/texture_use.h"
#include "fovea/saliency/texture_signals.h"

namespace fovea {

/// The signals of a surface by number, those of one texture together.
enum class Signal : std::size_t {
  intensity,
  opponency,
  entropy,
  emission,
  roughness,
  metalness,
  normal_detail
};
inline constexpr std::size_t kSignals = 7;

/// The roles of textures that give signals.
inline constexpr TextureRole kSignalRoles[] = {TextureRole::base_color, TextureRole::emissive,
                                               TextureRole::metallic_roughness, TextureRole::normal};

/// The first of the signals that a texture gives.
Signal first_signal(TextureRole role);

/// All that the signals of texels depend on: materials that agree in it share them. Sorted by image.
struct TexelSource {
  int image = -1;
  TextureRole role = TextureRole::base_color;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  std::array<double, 3> factor{1, 1, 1};  ///< What the material multiplies red, green and blue by.
  friend auto operator<=>(const TexelSource&, const TexelSource&) = default;
};

/// Mean signals of the texels of a triangle near each of its corners: those have the square of the corner's
/// weight there.
class TexelMeans {
 public:
  void add(const std::array<float, 3>& signals, const std::array<double, 3>& corners, double weight = 1) {
    if (is_empty_) first_ = signals;
    is_empty_ = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const double w = weight * (corners[c] * corners[c] + kLeastWeight);
      weight_[c] += w;
      for (std::size_t k = 0; k < 3; ++k) sum_[c][k] += w * static_cast<double>(signals[k] - first_[k]);
    }
  }
  bool empty() const { return is_empty_; }
  float mean(std::size_t signal, std::size_t corner) const {
    return first_[signal] + static_cast<float>(sum_[corner][signal] / weight_[corner]);
  }

 private:
  static constexpr double kLeastWeight = 1e-4;  // a texel at another corner is better than none
  // Around the first, so that a constant stays what it is.
  bool is_empty_ = true;
  std::array<float, 3> first_{};
  std::array<std::array<double, 3>, 3> sum_{};  // [corner][signal]
  std::array<double, 3> weight_{};
};

/// Signals of a colour given as light, as bytes would store it.
ColorSignals signals_of_light(Vec3f light);
/// Grey of a colour given as light, as bytes would store it.
float grey_of_light(Vec3f light);

/// The signals of the texels of one source, ready to be looked at by triangles.
class MaterialTexels {
 public:
  /// With `tinted` vertex colours may multiply them, for six bytes more per texel.
  MaterialTexels(const TexelSource& source, const Image8& image, bool tinted,
                 const TextureSignalOptions& options, const Context& context);

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t signal_count() const { return planes_.size(); }

  /// Means over a triangle given in texels: over those whose centres it covers, in rows and columns that are
  /// multiples of `step`, or the bilinear sample in its middle if there are none. O(#texels covered).
  TexelMeans means(const std::array<Vec2d, 3>& triangle, std::int64_t step) const;
  /// The same where the texels are multiplied by colours (as light) of the corners.
  TexelMeans means(const std::array<Vec2d, 3>& triangle, std::int64_t step,
                   const std::array<Vec3f, 3>& tint) const;

 private:
  template <class F>
  TexelMeans means_of(const std::array<Vec2d, 3>& triangle, std::int64_t step, F&& signals) const;

  Sampler sampler_;
  int width_, height_;
  std::vector<ImageF> planes_;           // from the role's first signal on
  std::array<const float*, 3> plane_{};  // the last repeated
  Image<std::uint16_t> smooth_;          // if tinted
  std::vector<float> light_;             // of smoothed values, if tinted
};

}  // namespace fovea
