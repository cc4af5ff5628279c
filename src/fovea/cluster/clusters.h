#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/field.h"
#include "fovea/surface/scene_surface.h"

namespace fovea {

/// How a surface is divided.
enum class ClusterMethod {
  salient,      ///< Grown from salient seeds over what is alike in saliency and direction (Munaretti 2007).
  propagative,  ///< Grown by distance and direction alone (Sander et al. 2003).
  kmeans,       ///< By the nearest of several centres (Linde, Buzo, Gray 1980).
};

struct ClusterOptions {
  std::int64_t count = 32;  ///< Clusters, if there are as many triangles.
  ClusterMethod method = ClusterMethod::salient;
  std::int64_t rounds = 100;  ///< Most rounds of growing and seeding again.
};
OptionList describe(ClusterOptions& options);

/// Why no further round was needed.
enum class ClusterEnd {
  converged,  ///< The seeds did not move any more.
  cycle,      ///< They came back to where they had been.
  rounds,     ///< So many rounds were allowed.
};
const char* to_string(ClusterEnd end);

/// The triangles of a scene, each in one cluster.
struct Clusters {
  std::uint32_t count = 0;
  Field<FaceId, std::uint32_t> of_face;  ///< [#F of the scene]
  std::vector<std::uint32_t> seeds;      ///< [count], vertices that they grew from; of `kmeans` near centres.
  std::uint32_t rounds = 0;              ///< Taken.
  ClusterEnd end = ClusterEnd::converged;
};

/// Divides a scene. Every cluster has a triangle and is connected: through edges, and where the scene falls
/// apart into pieces through bridges between near ones (dual_graph.h). `saliency` [#V of the scene], 0 or
/// more; only `salient` looks at it, and where it is the same everywhere direction and distance decide alone.
/// Random choices are by the seed of `context`; the same for any number of threads, and in any unit of
/// length. How far from the publications, and why: docs/clusters.md.
///
/// Throws Error(usage) for options out of range or saliency of another scene, Error(unsupported) for a scene
/// without triangles or with corners that are not finite, Error(cancelled). O(rounds · #F log #F); `kmeans`
/// O(rounds · #F · count^(2/3)).
Clusters make_clusters(const SceneSurface& scene, const VertexField& saliency, const ClusterOptions& options,
                       Context& context);

}  // namespace fovea
