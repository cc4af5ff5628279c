#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/budget/picture_loss.h"
#include "fovea/io/file_form.h"
#include "fovea/model/model.h"
#include "fovea/render/view.h"
#include "fovea/texture/image_output.h"

namespace fovea {

/// How like the original a result has to be, over what either covers, base colour and lit alike.
enum class FitMetric {
  psnr,     ///< dB at least,
  ms_ssim,  ///< 0 … 1 at least,
  flip,     ///< 0 … 1 at most.
};

/// How the ladders are walked (marginal.h).
enum class FitSearch { prune, grow, exhaustive };

/// Whether all meshes are one ladder and all images another, or each is one of its own.
enum class FitLadderSet { joint, separate };

/// What may be given away.
enum class FitGives { both, triangles, texels };

struct FitOptions {
  std::optional<std::int64_t> triangles;           ///< To keep at most.
  ViewOptions views{.set = ViewSet::icosahedron};  ///< That pictures are compared from.
  std::int64_t view_size = 512;  ///< Pixels along each side: how large the model will be looked at.
  Distortion distortion = Distortion::mse;  ///< What is lost in pictures.
  FitSearch search = FitSearch::prune;
  FitLadderSet ladders =
      FitLadderSet::joint;  ///< Always beyond eight meshes, or images, and for `exhaustive`.
  TextureOutput format = TextureOutput::keep;
  FitGives gives = FitGives::both;
  std::int64_t fineness = 1;     ///< Rungs of a ladder for each usual one: a way of more points.
  FileForm form;                 ///< As the file will be written.
  std::uint64_t most_bytes = 0;  ///< No larger budget will be asked for, which saves time; 0 for any.
};
OptionList describe(FitOptions& options);

/// A choice of triangles and texels, measured.
struct FitPoint {
  std::uint64_t triangles = 0;
  std::uint64_t image_bytes = 0;
  std::uint64_t bytes = 0;  ///< Of the whole file; of points on the way at most so many.
  double loss = 0;          ///< By FitOptions::distortion.
  double psnr_db =
      0;  ///< Of base colour and lit over what either covers, all views together; infinite if equal.
};

struct FitResult {
  Model model;
  FitPoint chosen;
  bool reached = true;     ///< Whether it keeps to the bytes, or is as like as asked.
  bool cancelled = false;  ///< Whether it is only the best that was known when it was.
  /// From the original to the end of the walk the lower hull of what was drawn; all steps if it grew.
  std::vector<FitPoint> path;
  std::size_t pictures = 0;  ///< Models drawn so far.
};

/// Spends one budget of bytes on the triangles and the texels of a model so that pictures lose least.
///
/// The model is simplified once (mesh_ladder.h), and its images are stored in ways that take less and less
/// (texture_ladder.h); bytes are those of what will be written. Marginal analysis (marginal.h; Horbelt,
/// Balmelli and Vetterli 2001) walks down the ladders of meshes and images until it is within the budget. Its
/// end is held against all sizes of all images together with as many triangles as fit beside them; around the
/// best of these, more or fewer triangles are tried with all other bytes spent on images; then triangles are
/// added as far as there is room, simplified anew with pictures deciding, and qualities of images tried more
/// finely. What loses least is the result.
///
/// No texels move and nothing is baked anew.
class BudgetFit {
 public:
  /// Makes the ladders. `model` and `context` must outlive this. Throws Error(usage) for options that do not
  /// go together, Error(unsupported) without triangles, Error(cancelled). Cost: one `simplify`, images
  /// encoded in tens of ways.
  BudgetFit(const Model& model, const FitOptions& options, Context& context);
  ~BudgetFit();

  /// The best of at most so many bytes, or if there is none, the smallest. What was measured for one budget
  /// is known for the next: the walk itself costs nothing again. If cancelled, the best so far. Pictures of
  /// about thirty models with ladders of the usual fineness, of more with finer ones.
  FitResult within(std::uint64_t bytes);

  /// The smallest that is as like as this. Throws Error(usage) for a value that the metric does not have,
  /// Error(cancelled).
  FitResult like(FitMetric metric, double value);

  /// The whole way from the original down, as `FitResult::path`.
  std::vector<FitPoint> way();
  /// All pairs of an exhaustive search; of others none.
  std::vector<FitPoint> all();
  /// The model of a point on it.
  Model at(std::size_t point);

 private:
  class Finder;
  std::unique_ptr<Finder> finder_;
};

}  // namespace fovea
