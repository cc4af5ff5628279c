#include "fovea/simplify/metric_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/render/exposure.h"
#include "fovea/render/scene.h"

namespace fovea {

namespace {

/// Pixels of all views together: some 50 bytes each.
constexpr double kMostPixels = 1 << 27;
constexpr std::uint64_t kMostSeen = 12000;
constexpr double kImageFrom = 2;
constexpr int kLargestView = 256, kSmallestView = 64, kViewStep = 16;
/// Of a view, for each triangle of the target.
constexpr double kPixels = 50;
/// Of what is not seen, and of what views from all around hardly see.
constexpr float kUnseen = 1e-3f, kLeastSeen = 0.2f;
/// Of a convex solid all around, which hides half of itself from everywhere.
constexpr float kConvexExposure = 0.5f;

bool looks_by_cameras(const SimplifyOptions& options) { return options.views.set == ViewSet::cameras; }

int image_size(std::uint64_t target) {
  const double size = std::sqrt(kPixels * static_cast<double>(target));
  const int steps = static_cast<int>(std::min(std::ceil(size / kViewStep), 1e3));
  return target == 0 ? kLargestView : std::clamp(steps * kViewStep, kSmallestView, kLargestView);
}

}  // namespace

MetricStage metric_stage(const SimplifyOptions& options, std::uint64_t target, std::uint64_t total) {
  const bool automatic = options.metric == Metric::automatic, is_by_cameras = looks_by_cameras(options);
  if (automatic && (target == 0 || (target > kMostSeen && !is_by_cameras) || options.per_mesh)) return {};
  MetricStage stage;
  stage.metric = automatic ? Metric::image : options.metric;
  stage.view_size = options.view_size               ? static_cast<int>(*options.view_size)
                    : stage.metric == Metric::image ? image_size(target)
                                                    : kLargestView;
  if (!stage.is_by_views()) return stage;
  std::optional<double> from = options.metric_from;
  if (!from && stage.metric == Metric::image) {
    from = kImageFrom;
    if (is_by_cameras && target > 0)
      from = std::max(kImageFrom, static_cast<double>(kMostSeen) / static_cast<double>(target));
  }
  const auto all = static_cast<double>(total);
  stage.from = from && target > 0
                   ? static_cast<std::uint64_t>(std::min(*from * static_cast<double>(target), all))
                   : total;
  return stage;
}

double pixel_count(std::span<const View> views, int size) {
  double sum = 0;
  for (const View& view : views) sum += static_cast<double>(picture_width(view, size)) * size;
  return sum;
}

ViewedModel viewed_model(const Model& model, const ViewOptions& options, const MetricStage& stage,
                         Context& context) {
  ViewedModel viewed;
  viewed.pose = rest_pose(model);
  viewed.scene = make_render_scene(model, viewed.pose, context, nullptr, SceneTextures::base_and_finish);
  viewed.views = views_of(options, model, viewed.pose, viewed.scene.sphere);
  if (stage.is_by_views() && pixel_count(viewed.views, stage.view_size) > kMostPixels) {
    throw Error(ErrorKind::limit,
                fmt::format("{} views that are {} pixels high are more than a metric looks at",
                            viewed.views.size(), stage.view_size),
                "--view-size", "take fewer or smaller views");
  }
  return viewed;
}

Importance exposed_importance(const Model& model, const ViewedModel& viewed, const SimplifyOptions& options,
                              const MetricStage& stage, const Context& context) {
  const bool is_all_around = stage.metric == Metric::image && !looks_by_cameras(options);
  const float scale = is_all_around ? 1 / kConvexExposure : 1, least = is_all_around ? kLeastSeen : kUnseen;
  Importance fields = exposure(viewed.scene, model.meshes.size(), viewed.views, stage.view_size, context);
  for (VertexField& field : fields) {
    for (float& x : field.values()) x = std::max(scale * x, least);
  }
  return fields;
}

}  // namespace fovea
