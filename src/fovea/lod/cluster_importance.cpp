#include "fovea/lod/cluster_importance.h"

#include <algorithm>
#include <array>

#include "fovea/cluster/cluster_properties.h"
#include "fovea/simplify/salient.h"
#include "fovea/surface/neighborhood.h"

namespace fovea {

namespace {

constexpr double kSmoothing = 0.006;  // of the diagonal

}  // namespace

Importance cluster_importance(const Model& model, const SceneSurface& scene, const VertexField& saliency,
                              const Clusters& clusters, const Context& context) {
  const VertexField local = local_saliency(scene, saliency, clusters);
  Surface surface = scene.surface;
  scale(surface, unit_scale(surface));
  const std::array<double, 1> width{kSmoothing * diagonal(surface)};
  VertexField smooth = gaussian_averages(surface, Adjacency(surface, context), {&local, 1}, width,
                                         {.distance = DistanceKind::diffusion}, context)[0][0];
  // To 0 … 1, as saliency is.
  const float most = std::ranges::max(smooth.values());
  for (float& s : smooth.values()) s = most > 0 ? std::clamp(s / most, 0.0f, 1.0f) : 0.0f;
  SalientOptions options;
  options.weighting = SaliencyWeighting::lee;
  return salient_importance(model, split(scene, smooth), options, context);
}

}  // namespace fovea
