#include "fovea/cluster/clusters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/cluster/cluster_ground.h"
#include "fovea/cluster/connect.h"
#include "fovea/cluster/growth.h"
#include "fovea/cluster/kmeans.h"
#include "fovea/cluster/seed_history.h"
#include "fovea/cluster/seeds.h"
#include "fovea/surface/local_order.h"

namespace fovea {

namespace {

void check_saliency(const SceneSurface& scene, const VertexField& saliency) {
  if (saliency.size() != scene.surface.positions.size())
    throw Error(ErrorKind::usage, fmt::format("saliency has {} values but the scene has {} vertices",
                                              saliency.size(), scene.surface.positions.size()));
  for (const float s : saliency.values()) {
    if (!(s >= 0 && std::isfinite(s)))
      throw Error(ErrorKind::usage, fmt::format("saliency of {} at a vertex", s));
  }
}

/// Growing and seeding again until the seeds come back.
void grow(const ClusterGround& ground, std::vector<std::uint32_t> seeds, std::uint32_t most_rounds,
          Clusters& clusters, std::vector<std::uint32_t>& of_face, Context& context) {
  Growth growth(ground);
  SeedHistory history;
  history.add(seeds);
  for (;;) {
    context.advance_or_throw("cluster", static_cast<double>(clusters.rounds) / most_rounds);
    of_face = growth.grow(seeds);
    ++clusters.rounds;
    std::vector<std::uint32_t> next = inner_seeds(ground, of_face, seeds, context);
    const std::optional<ClusterEnd> end = history.add(next);
    if (end || clusters.rounds == most_rounds) {
      clusters.end = end.value_or(ClusterEnd::rounds);
      clusters.seeds = std::move(seeds);
      return;
    }
    seeds = std::move(next);
  }
}

std::vector<std::uint32_t> peak_vertices(const ClusterGround& ground,
                                         const std::vector<std::uint32_t>& faces) {
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t f : faces) vertices.push_back(ground.peak_vertex(f));
  return vertices;
}

}  // namespace

OptionList describe(ClusterOptions& o) {
  return {{"clusters", "How many clusters; as many as there are triangles if there are fewer.", &o.count, "",
           1, 1 << 24},
          {"method",
           "Grown over what is alike in saliency and direction, by distance and direction alone, or by the "
           "nearest "
           "of several centres.",
           choice(o.method, {"salient", "propagative", "kmeans"}), ""},
          {"rounds", "Most rounds of growing clusters and finding their middles.", &o.rounds, "", 1, 100000}};
}

const char* to_string(ClusterEnd end) {
  switch (end) {
    case ClusterEnd::converged: return "converged";
    case ClusterEnd::cycle: return "cycle";
    default: return "rounds";
  }
}

Clusters make_clusters(const SceneSurface& scene, const VertexField& saliency, const ClusterOptions& options,
                       Context& context) {
  ClusterOptions checked = options;
  check(describe(checked));
  check_saliency(scene, saliency);
  const std::size_t face_count = scene.surface.triangles.size();
  if (face_count == 0) throw Error(ErrorKind::unsupported, "the model shows no triangles");
  const LocalOrder order = local_order(scene.surface);
  Surface surface = reordered(scene.surface, order);
  scale(surface, unit_scale(surface));
  const bool salient = options.method == ClusterMethod::salient;
  const ClusterGround ground(std::move(surface), salient ? in_order(saliency, order) : VertexField(),
                             context);

  const std::size_t count = std::min(static_cast<std::size_t>(options.count), face_count);
  const auto most_rounds = static_cast<std::uint32_t>(options.rounds);
  Clusters clusters;
  clusters.count = static_cast<std::uint32_t>(count);
  std::vector<std::uint32_t> of_face;
  if (options.method == ClusterMethod::kmeans) {
    KMeans found =
        k_means(ground.graph, spread_faces(ground.graph, count, context.seed), most_rounds, context);
    clusters.rounds = found.rounds;
    clusters.end = found.end;
    of_face = std::move(found.of_face);
    connect(ground, of_face, count);
    clusters.seeds = peak_vertices(ground, nearest_faces(ground.graph, of_face, found.centers));
  } else {
    grow(ground,
         salient ? salient_seeds(ground, count, context.seed)
                 : peak_vertices(ground, spread_faces(ground.graph, count, context.seed)),
         most_rounds, clusters, of_face, context);
  }
  clusters.of_face = Field<FaceId, std::uint32_t>(face_count);
  for (std::size_t f = 0; f < face_count; ++f) clusters.of_face[order.faces[f]] = of_face[f];
  for (std::uint32_t& seed : clusters.seeds) seed = order.vertices[seed].value;
  return clusters;
}

}  // namespace fovea
