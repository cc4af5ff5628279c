#include "fovea/budget/picture_loss.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/judge/silhouette.h"
#include "fovea/model/image_error.h"

namespace fovea {

namespace {

/// Of images that are kept decoded.
constexpr std::int64_t kMostKeptTexels = std::int64_t{1} << 26;

constexpr std::array<Pass, 2> kPasses{Pass::base_color, Pass::lit};

RenderOptions picture_options(const CompareOptions& options, const View& view) {
  RenderOptions picture;
  picture.width = picture_width(view, options.size);
  picture.height = options.size;
  picture.samples = options.samples;
  return picture;
}

}  // namespace

PictureLoss::PictureLoss(const Model& original, const ViewOptions& views, int size, Distortion distortion,
                         Context& context)
    : original_(original),
      distortion_(distortion),
      context_(context),
      scene_(make_render_scene(original, rest_pose(original), context)) {
  options_.views = views;
  options_.size = size;
  options_.distance_samples = 0;
  decoded_.images = scene_.images;
  views_ = views_of(views, original, rest_pose(original), scene_.sphere);
  seen_.resize(views_.size());
  parallel_for_or_throw(context, views_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (Picture& picture :
           render_passes(scene_, views_[v], kPasses, picture_options(options_, views_[v]), context_)) {
        Seen& seen = seen_[v].emplace_back(Seen{std::move(picture), std::nullopt, std::nullopt});
        if (distortion_ == Distortion::ms_ssim) seen.ssim.emplace(seen.picture.color);
        if (distortion_ == Distortion::flip) seen.flip.emplace(seen.picture.color);
      }
    }
  });
}

double PictureLoss::distortion_of(const Seen& seen, const Picture& test, const Plane& mask,
                                  double squared) const {
  if (seen.ssim) return 1 - seen.ssim->score(test.color, &mask).ms_ssim_masked;
  if (seen.flip) return mean(seen.flip->map(test.color), &mask);
  return squared;
}

void PictureLoss::keep_images(const RenderScene& scene) {
  const auto texels = [](const SceneImage& image) {
    return std::int64_t{image.map->width()} * image.map->height();
  };
  for (const SceneImage& image : scene.images) {
    if (std::ranges::any_of(decoded_.images, [&](const SceneImage& known) { return known.map == image.map; }))
      continue;
    kept_.push_back(*image.image);
    decoded_.images.push_back({&kept_.back(), image.encoding, image.map});
  }
  std::int64_t sum = 0;
  for (const SceneImage& image : decoded_.images) sum += texels(image);
  // The original's come first and stay.
  while (sum > kMostKeptTexels && !kept_.empty()) {
    const auto oldest = decoded_.images.begin() + static_cast<std::ptrdiff_t>(scene_.images.size());
    sum -= texels(*oldest);
    decoded_.images.erase(oldest);
    kept_.pop_front();
  }
}

PictureLoss::Loss PictureLoss::of(const Model& model) {
  const RenderScene scene = make_render_scene(model, rest_pose(model), context_, &decoded_);
  keep_images(scene);
  std::vector<Loss> losses(views_.size());
  parallel_for_or_throw(context_, views_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::vector<Picture> tests =
          render_passes(scene, views_[v], kPasses, picture_options(options_, views_[v]), context_);
      const Plane mask = foreground(seen_[v][0].picture.coverage, tests[0].coverage);
      for (std::size_t p = 0; p < kPasses.size(); ++p) {
        const Seen& seen = seen_[v][p];
        const double squared = mean_squared_error(seen.picture.color, tests[p].color, mask.values);
        losses[v].squared += squared;
        losses[v].value += distortion_of(seen, tests[p], mask, squared);
      }
    }
  });
  Loss sum;
  for (const Loss& loss : losses) sum = {sum.value + loss.value, sum.squared + loss.squared};
  const auto pictures = static_cast<double>(kPasses.size() * views_.size());
  return {sum.value / pictures, sum.squared / pictures};
}

Comparison PictureLoss::scores(const Model& model) {
  const Model* const tests[] = {&model};
  return compare(original_, tests, options_, context_).front();
}

std::function<double(const Model&)> loss_by_pictures(const Model& original, const ViewOptions& views,
                                                     double shown_pixels, Context& context) {
  if (counts(original).triangles == 0) return {};
  constexpr double kUsual = 512, kLeast = 64, kMost = 2048;
  const double size = std::clamp(shown_pixels > 0 ? shown_pixels : kUsual, kLeast, kMost);
  const auto pictures =
      std::make_shared<PictureLoss>(original, views, static_cast<int>(size), Distortion::mse, context);
  return [pictures](const Model& model) { return pictures->of(model).value; };
}

}  // namespace fovea
