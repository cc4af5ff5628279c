#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/io/write.h"
#include "fovea/model/model.h"
#include "fovea/render/view.h"
#include "fovea/texture/image_output.h"

namespace fovea {

/// How like the original a result has to be.
enum class FitMetric { none, psnr, ms_ssim, flip };

struct FitOptions {
  std::optional<std::uint64_t> bytes;     ///< Of the whole file, at most.
  std::optional<std::int64_t> triangles;  ///< At most.
  FitMetric match = FitMetric::none;      ///< Instead of `bytes`: the smallest file that is as like as
  double match_value = 0;  ///< this: dB, 0 … 1, or FLIP's error, over what either covers, base colour and
                           ///< lit alike.
  ViewOptions views{.set = ViewSet::icosahedron};  ///< That pictures are compared from.
  std::int64_t view_size = 512;  ///< Pixels along each side: how large the model will be looked at.
  bool whole_path =
      false;  ///< The path has choices for more than `bytes` too; with large images some seconds more.
  TextureOutput format = TextureOutput::keep;
  WriteOptions write;          ///< As the file will be written,
  bool binary = true;          ///< GLB, or glTF with files beside it,
  std::string stem = "model";  ///< named after this: names take bytes too.
};
OptionList describe(FitOptions& options);

/// A choice of triangles and texels, measured.
struct FitPoint {
  std::uint64_t triangles = 0;
  std::uint64_t image_bytes = 0;
  std::uint64_t bytes = 0;  ///< Of the whole file.
  double psnr_db =
      0;  ///< Of base colour and lit over what either covers, all views together; infinite if equal.
};

struct FitResult {
  Model model;
  FitPoint chosen;
  bool reached = true;  ///< Whether it keeps to the bytes, or is as like as asked.
  std::vector<FitPoint>
      path;                  ///< From the original down, as pruning went; the choice for any number of bytes.
  std::size_t pictures = 0;  ///< Models that were drawn for it.
};

/// Spends one budget of bytes on the triangles and the texels of a model so that pictures lose least.
///
/// The model is simplified once, and its images are stored in ways that take less and less (shrink.h); both
/// make ladders, sizes in geometric progression, bytes as they will be written. Marginal analysis by pruning
/// (marginal.h) walks down from the original. The point where it comes below the budget is held against every
/// size of images with as many triangles as fit beside them; around the best of these, neighbouring numbers
/// of triangles are tried with all other bytes spent on images, then more triangles as far as there is room.
/// With `match` the walk goes on to the end, and the last point is taken that is as like as asked.
///
/// No texels move and nothing is baked anew. Throws Error(usage) for options that do not go together,
/// Error(unsupported) without triangles that anything shows, Error(cancelled). Cost: one `simplify`, textures
/// as for
/// `--texture-bytes`, and pictures of some thirty models.
FitResult fit(const Model& model, const FitOptions& options, Context& context);

}  // namespace fovea
