#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/judge/picture_scores.h"
#include "fovea/judge/surface_distance.h"
#include "fovea/model/model.h"
#include "fovea/render/render.h"
#include "fovea/render/view.h"
#include "fovea/surface/pose.h"

namespace fovea {

/// The passes that are compared.
enum class JudgedPass { base_color, lit };
constexpr std::array<JudgedPass, 2> kJudgedPasses{JudgedPass::base_color, JudgedPass::lit};

/// One view of two models.
struct ViewComparison {
  std::string name;
  std::array<ImageScores, 2> passes;  ///< By JudgedPass.
  double silhouette_iou = 1;
};

/// What comparing a model with a reference found.
struct Comparison {
  std::vector<ViewComparison> views;
  /// Over all views: means, but `mse` over all pixels of all views, and `psnr` from that.
  std::array<ImageScores, 2> passes;
  double silhouette_iou = 1;
  std::optional<SurfaceDistance> distance;  ///< In scene units, if it was measured,
  double reference_diagonal = 0;            ///< of which this is the diagonal of the reference's box.

  const ImageScores& operator[](JudgedPass pass) const { return passes[static_cast<std::size_t>(pass)]; }
};

struct CompareOptions {
  PoseOptions pose;          ///< Of all models.
  ViewOptions views;         ///< Framed by the reference's bounding sphere, for both models.
  std::int64_t size = 512;   ///< Pixels along each side of a view.
  std::int64_t samples = 2;  ///< As RenderOptions.
  double pixels_per_degree = kFlipPixelsPerDegree;
  std::int64_t distance_samples = 50000;  ///< On each surface; 0 does not measure the distance.
};
OptionList describe(CompareOptions& options);

/// Whoever wants to see what is compared. Called from any thread, in any order, each view, test and pass
/// once; of one view all tests in order from one thread.
struct CompareObserver {
  /// Before all others.
  std::function<void(std::size_t views, std::size_t tests)> begin;
  /// Both pictures of a view, and FLIP's error map.
  std::function<void(std::size_t view, std::size_t test, JudgedPass pass, const Picture& reference,
                     const Picture& picture, const Plane& flip)>
      pictures;
  /// A picture of the test in which heat is the distance to the reference: 0 … `kHottestDistance`.
  std::function<void(std::size_t view, std::size_t test, const Picture& heat)> distances;
};
/// Of the reference's diagonal.
constexpr double kHottestDistance = 0.005;

/// Compares each of `tests` with the reference: the same cameras (by default those of the
/// protocol of Yang et al. 2016: 24 at the vertices of the small rhombicuboctahedron), base colour and lit,
/// and the surfaces themselves.
///
/// Throws Error(unsupported) for a reference with no triangles and for an animation that a model lacks. The
/// same for any number of threads. Views are worked on one by one per thread, so that memory does not grow
/// with their number.
std::vector<Comparison> compare(const Model& reference, std::span<const Model* const> tests,
                                const CompareOptions& options, Context& context,
                                const CompareObserver& observer = {});

/// All triangles of a scene, in world space, with the winding that their meshes have.
Surface triangles_of(const RenderScene& scene);

}  // namespace fovea
