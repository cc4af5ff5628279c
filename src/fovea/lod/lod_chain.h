#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/base/options.h"
#include "fovea/io/file_form.h"
#include "fovea/judge/compare.h"
#include "fovea/lod/lod_chain_screen.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"
#include "fovea/texture/shrink.h"

namespace fovea {

/// Which levels a chain has, besides the original, which is level 0. The first of `triangles`, `coverages`
/// and `distances` that is not empty says; `levels` and `ratio` if all are.
struct LodChainOptions {
  std::int64_t levels = 4;                 ///< With the original,
  double ratio = 0.5;                      ///< each with this part of the triangles of the one before.
  std::vector<std::int64_t> triangles;     ///< Of levels 1, 2, ..., falling.
  std::vector<double> coverages;           ///< Where levels 1, 2, ... come in (lod_chain_screen.h), falling:
  std::vector<double> distances;           ///< or at which distances, rising. Each level is as simple as a
  LodScreen screen;                        ///< measured error of `pixel_error` pixels there allows.
  SimplifyOptions simplify;                ///< How; its targets do not count, `per_mesh` must be off.
  const CollapseRecord* record = nullptr;  ///< Steps that are known; nothing is simplified then.
  /// Of the files of levels 1, 2, ... of `triangles`, as `form` says, at most: images get what the triangles
  /// leave. Or empty.
  std::vector<std::uint64_t> bytes;
  FileForm form;
  bool textures_follow = true;  ///< Images get as many texels as the level has pixels where it comes in.
  ShrinkOptions textures;       ///< How; its `scales` and `max_bytes` do not count.
  /// Poses in which errors are measured on all points, besides rest; 0 to 64. With 0 motion does not count.
  std::int64_t key_poses = 4;
  std::int64_t distance_samples = 50000;  ///< Points on each surface for that.
  bool pictures = true;                   ///< Whether pictures of each level are compared, too.
};
/// `levels`, `ratio`, `key_poses` and `distance_samples`.
OptionList describe(LodChainOptions& options);

/// How far a level is from the original, both ways, in scene units (surface_distance.h): the largest distance
/// over all poses of animations and morph targets (`motion_poses`, key_poses.h), the largest mean over the
/// rest pose and key poses.
struct LodError {
  double max = 0, mean = 0;
};

struct LodLevel {
  Model model;
  std::uint64_t triangles = 0;  ///< Each mesh once.
  LodError error;
  double distance = 0;  ///< From which on it is shown: 0 for the original,
  double coverage = 0;  ///< the same as coverage, for which this is 0, too;
  double pixels = 0;    ///< and what its error takes on the screen there.
  /// Pictures of it at rest against those of the original, over the 24 views of `CompareOptions`, by
  /// JudgedPass, as large as the level is where it comes in, but no larger than the screen is high.
  std::array<ImageScores, 2> pictures;
  std::int64_t picture_size = 0;    ///< Pixels along each side; 0 if none were made.
  std::uint64_t most_bytes = 0;     ///< That its file may take; 0 for any.
  std::vector<ImageChange> images;  ///< [#images] Empty if none were to change.
};

struct LodChain {
  std::vector<LodLevel> levels;  ///< From the finest, which is the original, to the coarsest.
  Sphere sphere;                 ///< Of the original at rest,
  double diagonal = 0;           ///< and the diagonal of its box.
  LodScreen screen;
  bool reached = true;              ///< Whether all levels have the triangles that were asked for, or fewer.
  Metric metric = Metric::quadric;  ///< What decided in the end, never `automatic`.
  std::uint64_t metric_from = 0;    ///< As SimplifyResult's.
};

/// Simplifies once, down to the coarsest level, and takes every other from the steps on the way (record.h),
/// so that a level is always what the one before it becomes.
///
/// From level to level triangles fall and the largest error rises: a level that has no fewer triangles than
/// the one before it is left out ("lod-not-fewer"), and so is one whose error is no less than that of the
/// next
/// ("lod-not-nearer"). Levels of given counts come in where their error takes `pixel_error` pixels.
///
/// `Metric::automatic` is quadrics for all levels but the coarsest of given counts, which has the last part
/// of its way, from twice its triangles or the level before on, decided by pictures if it is small enough
/// (metric_stage.h): every level above it is then the same as without pictures. It is quadrics alone where
/// levels follow from the screen, as nobody knows the coarsest beforehand.
///
/// Throws Error(usage) for options out of range, lists that do not fall or rise, and distances within the
/// sphere; Error(unsupported) for a model that shows no triangles or has levels already (MSFT_lod);
/// Error(cancelled). The same for any number of threads.
LodChain make_lod_chain(const Model& model, const LodChainOptions& options, const Importance& importance,
                        Context& context);

}  // namespace fovea
