#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/budget/fit.h"
#include "fovea/budget/marginal.h"
#include "fovea/budget/mesh_ladder.h"
#include "fovea/budget/picture_loss.h"
#include "fovea/texture/image_viewers.h"
#include "fovea/texture/texture_ladder.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// How far each mesh ladder is simplified, and how each image is stored.
struct FitChoice {
  std::vector<std::size_t> steps;  ///< [#mesh ladders]
  std::vector<std::size_t> ways;   ///< [#images] As TextureLadders.
  friend auto operator<=>(const FitChoice&, const FitChoice&) = default;
};

/// The ladders of one model: what choices take, lose, and are.
class FitLadders {
 public:
  /// Throws as BudgetFit. Cost: one simplification, and images encoded in many ways.
  FitLadders(const Model& model, const FitOptions& options, Context& context);

  const Model& original() const { return model_; }
  const MeshLadders& meshes() const { return meshes_; }
  /// None if there are no images that may change.
  TextureLadders* textures() { return textures_.get(); }
  /// For all images together, from the files as they are down: ways that lose least [#images].
  const std::vector<std::vector<std::size_t>>& image_levels() const { return image_levels_; }

  JointLadders joint();  ///< Refer to this.
  FitChoice choice(const Rungs& rungs) const;
  FitChoice whole() const { return choice(Rungs(joint_count(), 0)); }

  /// Of the whole file, at most; estimated between the rungs of meshes.
  std::uint64_t bytes(const FitChoice& choice);
  std::uint64_t image_bytes(const FitChoice& choice);
  /// Of these what the mesh ladders take above their ends.
  double mesh_bytes(const FitChoice& choice) const;
  /// All mesh ladders made to take so many bytes together, each in the proportion that it has.
  std::vector<std::size_t> steps_within(const std::vector<std::size_t>& steps, double bytes) const;

  Model model(const FitChoice& choice);
  /// Its images.
  void set_images(Model& model, const std::vector<std::size_t>& ways);
  /// Exactly what is written.
  std::uint64_t file_bytes(const Model& model);

  /// Measured in pictures, once for each choice. Throws Error(cancelled).
  PictureLoss::Loss loss(const FitChoice& choice);
  PictureLoss::Loss loss(const Model& model);
  /// Of what the file will hold: with its integers.
  Comparison scores(const Model& model);
  std::size_t pictures_drawn() const { return drawn_; }

  Context& scratch() { return scratch_; }  ///< What is tried is not told.
  /// From now on cancelling is not heard any more: what is known is put together.
  void finish_up() { is_finishing_ = true; }

 private:
  std::size_t joint_count() const { return meshes_.rungs().size() + image_ladders_.size(); }
  void make_image_ladders(const FitOptions& options);
  void make_image_levels();

  /// Ways of some images, rung by rung.
  struct ImageLadder {
    std::vector<std::size_t> images;
    std::vector<std::vector<std::size_t>> ways;  // [#rungs][#images of it]
  };

  const Model& model_;
  const FitOptions& options_;
  Context& context_;
  Context scratch_;
  PictureLoss pictures_;
  MeshLadders meshes_;
  std::optional<ImageViewers> viewers_;
  std::unique_ptr<TextureLadders> textures_;
  std::vector<std::vector<std::size_t>> image_levels_;
  std::vector<ImageLadder> image_ladders_;
  std::map<FitChoice, PictureLoss::Loss> known_;
  bool is_finishing_ = false;
  std::size_t drawn_ = 0;
  std::size_t expected_ = 0;  // models to draw, about
};

}  // namespace fovea
