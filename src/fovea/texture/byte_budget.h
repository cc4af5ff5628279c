#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/image_output.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/size_ladder.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Finds sizes and qualities for a model's images whose files together may take so many bytes, so that least
/// is lost of what is seen.
///
/// Each image may be stored in the ways of `image_steps`, from its limit down to 1/32 of the sides that it
/// has. What a way loses counts by the surface that shows the image (`seen_area`), where that is looked at.
/// Steps are taken where they lose least for each byte they save (`choose_steps`); then images are encoded as
/// chosen, by resizing alone, and estimates corrected by what that takes, until it fits.
class ByteBudget {
 public:
  /// Images that `limits` [#images] have no size for take what they take. Refers to the model and the
  /// atlases. Throws Error(cancelled).
  ByteBudget(const Model& model, std::span<const Atlas> atlases, std::span<const WantedImage> limits,
             const ImageOutputOptions& options, std::span<const VertexField> field, Context& context);

  /// [#images] Of those whose files fit what loses least; the fewest bytes of all if none do.
  std::vector<WantedImage> choose(double bytes);

 private:
  struct Candidate {
    std::size_t image = 0;
    const Atlas* atlas = nullptr;
    Image8 whole{};                              // as it is to be resized; empty if there is no room for it
    std::vector<LadderStep> steps{};             // as estimated
    double correction = 1;                       // of their bytes
    std::vector<std::optional<double>> exact{};  // [#steps] bytes of those that were encoded
  };
  using Numbers = std::vector<std::size_t>;  // [#candidates] of steps

  Image8 whole(const Candidate& candidate) const;
  /// All triangles that show it; none if they are not known.
  std::vector<AtlasFace> known_faces(const Candidate& candidate) const;
  Image8 picture(const Candidate& candidate, int width, int height) const;
  void measure(Candidate& candidate, const ImageF& weights, double area) const;
  double encoded_bytes(const Candidate& candidate, const LadderStep& step) const;
  Numbers numbers_within(double bytes) const;
  double encode(const Numbers& numbers);
  double loss(const Numbers& numbers) const;
  std::vector<WantedImage> wanted(const Numbers& numbers) const;

  const Model& model_;
  std::vector<WantedImage> limits_;
  ImageOutputOptions options_;
  Context& context_;
  std::vector<ImageUse> uses_;
  std::vector<Candidate> candidates_;
  double kept_bytes_ = 0;
  bool is_roomy_ = true;
};

}  // namespace fovea
