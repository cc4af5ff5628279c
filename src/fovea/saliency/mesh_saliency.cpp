#include "fovea/saliency/mesh_saliency.h"

#include "fovea/saliency/contrast.h"
#include "fovea/surface/curvature.h"
#include "fovea/surface/local_order.h"

namespace fovea {

namespace {

MeshSaliency saliency_in_order(const Surface& surface, const MeshSaliencyOptions& options,
                               const Context& context) {
  const Adjacency adjacency(surface, context);
  MeshSaliency result;
  result.curvature = mean_curvature(surface, adjacency, context);
  result.saliency = VertexField(surface.positions.size());
  const double unit = options.unit_rel * diagonal(surface);
  if (!(unit > 0)) return result;
  std::vector<ScalePair> pairs;
  for (int i = 2; i <= 6; ++i) pairs.push_back({i * unit, 2 * i * unit});
  result.contrasts =
      center_surround(surface, adjacency, {&result.curvature, 1}, pairs, options.neighborhood, context)[0];
  for (const VertexField& contrast : result.contrasts) {
    const VertexField promoted = promote_peaks(contrast, adjacency);
    for (std::uint32_t v = 0; v < promoted.size(); ++v) {
      if (!adjacency.corners(v).empty()) result.saliency.values()[v] += promoted.values()[v];
    }
  }
  return result;
}

}  // namespace

MeshSaliency mesh_saliency(const Surface& surface, const MeshSaliencyOptions& options,
                           const Context& context) {
  const LocalOrder order = local_order(surface);
  const double unit = unit_scale(surface);
  Surface worked = reordered(surface, order);
  scale(worked, unit);
  MeshSaliency result = saliency_in_order(worked, options, context);
  const auto own = [&](VertexField field) {
    for (float& x : field.values()) x = static_cast<float>(unit * static_cast<double>(x));
    return in_own_order(field, order);
  };
  result.curvature = own(result.curvature);
  for (VertexField& contrast : result.contrasts) contrast = own(contrast);
  result.saliency = in_own_order(result.saliency, order);
  return result;
}

}  // namespace fovea
