#include "fovea/simplify/metric_stage.h"

#include <algorithm>

#include "fovea/render/exposure.h"
#include "fovea/render/scene.h"

namespace fovea {

namespace {

constexpr std::uint64_t kMostSeen = 50000;
constexpr double kImageFrom = 3;
constexpr float kUnseen = 1e-3f;

}  // namespace

MetricStage metric_stage(const SimplifyOptions& options, std::uint64_t target, std::uint64_t total) {
  const bool automatic = options.metric == Metric::automatic;
  if (automatic && (target == 0 || target > kMostSeen || options.per_mesh)) return {};
  MetricStage stage{automatic ? Metric::image : options.metric, 0};
  if (!stage.is_by_views()) return stage;
  std::optional<double> from = options.metric_from;
  if (!from && stage.metric == Metric::image) from = kImageFrom;
  const auto all = static_cast<double>(total);
  stage.from = from && target > 0
                   ? static_cast<std::uint64_t>(std::min(*from * static_cast<double>(target), all))
                   : total;
  return stage;
}

Importance exposed_importance(const Model& model, const SimplifyOptions& options, Context& context) {
  const Pose pose = rest_pose(model);
  const RenderScene scene = make_render_scene(model, pose, context);
  const std::vector<View> views = views_of(options.views, model, pose, scene.sphere);
  Importance fields =
      exposure(scene, model.meshes.size(), views, static_cast<int>(options.view_size), context);
  for (VertexField& field : fields) {
    for (float& x : field.values()) x = std::max(x, kUnseen);
  }
  return fields;
}

}  // namespace fovea
