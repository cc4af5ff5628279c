#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/image_loss.h"
#include "fovea/texture/image_output.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/image_viewers.h"
#include "fovea/texture/image_ways.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Finds sizes and qualities for a model's images whose files together may take so many bytes, so that least
/// is lost of what is seen.
///
/// Each image is stored in many ways, from its limit down to 1/32 of the sides that it has (`image_ways`).
/// What pictures of each of some sizes lose by a way is seen on the surface that shows the image, where that
/// is looked at; squared, it adds up over the images, of colours alone and of all. Steps are taken where they
/// lose least for each byte they save (`choose_steps`), so that the product of these sums is least: a picture
/// of any size counts by how many times more or less it loses. More qualities are tried beside what is
/// chosen, and chosen again.
class TextureBudget {
 public:
  /// Images are those of the model; none may take as much as its file did before, in `files` [#images], whose
  /// formats stay. Those that materials read in different ways take what they take. `pixels` as for
  /// ImageSights; if `viewers` are given, which must outlive this, they look instead, and what they cannot
  /// see is not stored. Refers to the model, the files and the atlases. Throws Error(cancelled).
  TextureBudget(const Model& model, std::span<const ImageChange::State> files, std::span<const Atlas> atlases,
                std::span<const WantedImage> limits, const ImageOutputOptions& options,
                std::span<const VertexField> field, std::vector<double> pixels, double bytes,
                Context& context, const ImageViewers* viewers = nullptr);

  /// [#images] Of those whose files fit into so many bytes, at most those of the constructor, what loses
  /// least; the fewest bytes of all if none do. With `refine` more qualities are tried near those: some
  /// seconds for large images.
  std::vector<WantedImage> choose(double bytes, bool refine);
  /// The same as numbers of ways [#images], `kNoWay` for images that stay as they are.
  std::vector<std::size_t> choose_ways(double bytes, bool refine);
  /// Both of images that all have their own sides halved so many times, but for those that do not come so, as
  /// their files would only grow or they are not to be so large; empty if none do.
  std::vector<WantedImage> choose_halved(double bytes, int halvings, bool refine);
  std::vector<std::size_t> choose_halved_ways(double bytes, int halvings, bool refine);

  /// Those halved so many times by Lanczos alone and all encoded as near (`encoding_psnr`), as near as the
  /// bytes allow: what somebody would do who measures nothing. Empty if some are not to be so large, or none
  /// fit. Encodes all images seven times.
  std::vector<WantedImage> choose_alike(double bytes, int halvings) const;

  static constexpr std::size_t kNoWay = static_cast<std::size_t>(-1);
  /// Makes what is lost of an image count so many times.
  void set_weight(std::size_t image, double weight);
  /// The same of all images that hold colours, as against normals and other data. False if there are not
  /// both.
  bool set_color_weight(double weight);
  /// Those known so far; more come at the end. Empty for images that stay as they are.
  std::span<const ImageWay> ways(std::size_t image) const;
  /// What all pictures lose by a way to store the image, as they count for the whole model.
  double loss(std::size_t image, const ImageWay& way) const;
  /// The file of a way, the same as was measured.
  std::vector<std::uint8_t> encoded(std::size_t image, const ImageWay& way);

 private:
  struct Candidate {
    std::size_t image = 0;
    const Atlas* atlas = nullptr;
    double area = 0;    // of the surface that shows it, as it is looked at
    double weight = 1;  // of what is lost
    ImageLimits limits{};
    std::vector<ImageWay> ways{};
  };
  using Numbers = std::vector<std::size_t>;  // [#candidates] of ways
  using Sums = std::vector<double>;          // [#pixels × 2] of losses: of colours, and of all

  ImageSights sights(const Candidate& candidate) const;
  Image8 decoded(std::size_t image) const;
  /// What files are made of.
  Image8 shown(std::size_t image, Image8 picture) const;
  /// All triangles that show it; none if they are not known.
  std::vector<AtlasFace> known_faces(const Candidate& candidate) const;
  void measure(Candidate& candidate) const;
  /// Tries more ways that take no more than so many bytes, near any or near those that halve the sides so
  /// often.
  void refine(Candidate& candidate, double bytes, std::optional<int> halvings) const;
  /// Spends what is left of the bytes on higher qualities, of the largest file first.
  void fill_up(Numbers& numbers, double bytes);
  std::vector<std::size_t> chosen(double bytes, bool refine, std::optional<int> halvings);
  /// Adds the losses of a way.
  void add(Sums& sums, const Candidate& candidate, const ImageWay& way) const;
  /// What loses least of what takes no more than so many bytes, of all ways or of those that halve the sides
  /// so many times; empty if there are none.
  Numbers numbers_within(double bytes, std::optional<int> halvings = {}) const;
  bool is_halved(const Candidate& candidate, const ImageWay& way, int times) const;
  std::vector<std::size_t> ways_of(const Numbers& numbers) const;
  std::vector<WantedImage> wanted(std::span<const std::size_t> ways) const;
  /// [#candidates] Each encoded so near, or less if its file would grow; none where it would anyway.
  std::vector<std::optional<ImageOutput>> encoded_alike(std::span<const Image8> pictures,
                                                        double psnr_db) const;
  const Candidate* find(std::size_t image) const;
  double area(const Candidate& candidate) const { return candidate.area * candidate.weight; }

  const Model& model_;
  std::span<const ImageChange::State> files_;
  std::vector<WantedImage> limits_;
  std::span<const VertexField> field_;
  std::vector<double> pixels_;
  double most_bytes_;
  ImageOutputOptions options_;
  Context& context_;
  const ImageViewers* viewers_;
  std::vector<ImageUse> uses_;
  std::vector<Candidate> candidates_;
  double kept_bytes_ = 0;
  /// By image, width, height and filling: smaller images that were encoded.
  std::map<std::tuple<std::size_t, int, int, bool>, Image8> sized_;
};

}  // namespace fovea
