#include "fovea/budget/picture_loss.h"

#include <algorithm>

#include "fovea/base/parallel.h"
#include "fovea/judge/silhouette.h"
#include "fovea/model/image_error.h"

namespace fovea {

namespace {

constexpr std::array<Pass, 2> kPasses{Pass::base_color, Pass::lit};

RenderOptions picture_options(const CompareOptions& options) {
  RenderOptions picture;
  picture.width = picture.height = options.size;
  picture.samples = options.samples;
  return picture;
}

}  // namespace

PictureLoss::PictureLoss(const Model& original, const ViewOptions& views, int size, Context& context)
    : original_(original),
      context_(context),
      scene_(make_render_scene(original, rest_pose(original), context)) {
  options_.views = views;
  options_.size = size;
  options_.distance_samples = 0;
  views_ = views_of(views, original, rest_pose(original), scene_.sphere);
  pictures_.resize(views_.size());
  parallel_for_or_throw(context, views_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      pictures_[v] = render_passes(scene_, views_[v], kPasses, picture_options(options_), context_);
  });
}

double PictureLoss::squared(const Model& model) {
  const RenderScene scene = make_render_scene(model, rest_pose(model), context_, &scene_);
  std::vector<double> loss(views_.size());
  parallel_for_or_throw(context_, views_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::vector<Picture> test =
          render_passes(scene, views_[v], kPasses, picture_options(options_), context_);
      const Plane mask = foreground(pictures_[v][0].coverage, test[0].coverage);
      for (std::size_t p = 0; p < kPasses.size(); ++p)
        loss[v] += mean_squared_error(pictures_[v][p].color, test[p].color, mask.values);
    }
  });
  double sum = 0;
  for (const double l : loss) sum += l;
  return sum / static_cast<double>(kPasses.size() * views_.size());
}

Comparison PictureLoss::scores(const Model& model) {
  const Model* const tests[] = {&model};
  return compare(original_, tests, options_, context_).front();
}

}  // namespace fovea
