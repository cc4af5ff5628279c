#include "fovea/simplify/metric_stage.h"

#include <algorithm>
#include <cmath>

#include "fovea/render/exposure.h"
#include "fovea/render/scene.h"

namespace fovea {

namespace {

constexpr std::uint64_t kMostSeen = 12000;
constexpr double kImageFrom = 2;
constexpr int kLargestView = 256, kSmallestView = 64, kViewStep = 16;
/// Of a view, for each triangle of the target.
constexpr double kPixels = 50;
constexpr float kUnseen = 1e-3f;

int image_size(std::uint64_t target) {
  const double size = std::sqrt(kPixels * static_cast<double>(target));
  const int steps = static_cast<int>(std::min(std::ceil(size / kViewStep), 1e3));
  return target == 0 ? kLargestView : std::clamp(steps * kViewStep, kSmallestView, kLargestView);
}

}  // namespace

MetricStage metric_stage(const SimplifyOptions& options, std::uint64_t target, std::uint64_t total) {
  const bool automatic = options.metric == Metric::automatic;
  if (automatic && (target == 0 || target > kMostSeen || options.per_mesh)) return {};
  MetricStage stage;
  stage.metric = automatic ? Metric::image : options.metric;
  if (!stage.is_by_views()) return stage;
  stage.view_size = options.view_size               ? static_cast<int>(*options.view_size)
                    : stage.metric == Metric::image ? image_size(target)
                                                    : kLargestView;
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
  const RenderScene scene = make_render_scene(model, pose, context, nullptr, SceneTextures::base_and_finish);
  const std::vector<View> views = views_of(options.views, model, pose, scene.sphere);
  Importance fields = exposure(scene, model.meshes.size(), views,
                               static_cast<int>(options.view_size.value_or(kLargestView)), context);
  for (VertexField& field : fields) {
    for (float& x : field.values()) x = std::max(x, kUnseen);
  }
  return fields;
}

}  // namespace fovea
