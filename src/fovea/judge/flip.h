#pragma once

#include "fovea/base/math.h"
#include "fovea/judge/plane.h"

namespace fovea {

/// Pixels per degree of a 0.7 m wide screen of 3840 pixels seen from 0.7 m, as in the publication.
constexpr double kFlipPixelsPerDegree = 67.0206432765823;

/// An image as FLIP sees it, ready to be compared with others.
///
/// ꟻLIP for low dynamic range (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020):
/// differences that an observer notices who flips between two images. Colours are blurred by the eye's
/// contrast sensitivity at the viewing distance and compared in a Hunt-adjusted CIELAB space by the HyAB
/// distance; differences of edges and points make them count more.
class FlipReference {
 public:
  /// An sRGB image of three channels. Throws Error(usage) for another number of channels.
  explicit FlipReference(const Image8& image, double pixels_per_degree = kFlipPixelsPerDegree);

  /// The error at each pixel, 0 (not noticed) … 1. Throws Error(usage) for an image of another size.
  Plane map(const Image8& test) const;

 private:
  struct Seen {
    Plane lightness, a, b;  ///< Hunt-adjusted CIELAB after the eye's blur.
    Plane edges, points;    ///< Strength of features in the unblurred image.
    Vec3d at(std::size_t i) const {
      return {static_cast<double>(lightness.values[i]), static_cast<double>(a.values[i]),
              static_cast<double>(b.values[i])};
    }
  };
  Seen see(const Image8& image) const;

  int width_, height_;
  double pixels_per_degree_;
  Seen reference_;
};

}  // namespace fovea
