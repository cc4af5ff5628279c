#include "fovea/budget/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/budget/marginal.h"
#include "fovea/budget/picture_loss.h"
#include "fovea/io/gltf_write.h"
#include "fovea/model/image_error.h"
#include "fovea/simplify/simplify.h"
#include "fovea/texture/shrink.h"

namespace fovea {

namespace {

constexpr double kFewerTriangles = 0.7;  // from rung to rung
constexpr double kFewestTriangles = 0.005;
/// From so many triangles on pictures decide which go (simplify.h); up to there quadrics do as well.
constexpr double kMostByPictures = 12000;
constexpr double kFewerImageBytes = 0.6;
constexpr double kFewestImageBytes = 0.008;
/// Bytes of JSON that come at most when images get other sizes and formats (EXT_texture_webp).
std::uint64_t json_slack(const Model& model) {
  constexpr std::uint64_t kOnce = 128, kForEach = 96;
  return kOnce + kForEach * (model.images.size() + model.textures.size());
}

std::uint64_t image_bytes(const Model& model) {
  std::uint64_t sum = 0;
  for (const EncodedImage& image : model.images) sum += image.bytes.size();
  return sum;
}

/// Ladders of one model, and what their rungs take and lose together.
class Fitter {
 public:
  Fitter(const Model& model, const FitOptions& options, Context& context)
      : model_(model),
        options_(options),
        context_(context),
        pictures_(model, options.views, static_cast<int>(options.view_size), context) {
    scratch_.threads = context.threads;
    scratch_.seed = context.seed;
    scratch_.progress = [this](std::string_view, double) { return !context_.cancelled(); };
    make_mesh_ladder();
    make_texture_ladder();
  }

  FitResult run() {
    const std::uint64_t most = options_.match == FitMetric::none ? *options_.bytes : 0;
    std::vector<JointPoint> path = prune(ladders(), most);
    FitResult result;
    for (const JointPoint& point : path) result.path.push_back(fit_point(point));
    if (options_.match != FitMetric::none) {
      match(path, result);
    } else {
      result.reached = path.back().bytes <= most;
      const bool is_whole = path.size() == 1;
      const JointPoint end = result.reached && !is_whole ? best_within(path.back()) : path.back();
      result.model = combined(end.rungs);
      result.chosen = fit_point(end);
      if (result.reached && !is_whole) spend(end, result);
    }
    result.pictures = drawn_;
    return result;
  }

 private:
  struct MeshRung {
    std::size_t steps = 0;
    std::uint64_t triangles = 0;
    std::uint64_t bytes = 0;  ///< Of the file without images.
  };

  void make_mesh_ladder() {
    const std::uint64_t total = counts(model_).triangles;
    SimplifyOptions simplify_options;
    simplify_options.ratio = kFewestTriangles;
    const double fewest = std::max(1.0, kFewestTriangles * static_cast<double>(total));
    if (fewest < kMostByPictures) {
      simplify_options.metric = Metric::image;
      simplify_options.metric_from = kMostByPictures / fewest;
    }
    record_ = simplify(model_, simplify_options, {}, context_).record;
    const double most =
        options_.triangles ? static_cast<double>(*options_.triangles) : static_cast<double>(total);
    for (double triangles = std::min(most, static_cast<double>(total));;
         triangles = std::min(triangles * kFewerTriangles, triangles - 1)) {
      const std::size_t steps = record_.steps_to(static_cast<std::uint64_t>(std::max(triangles, 0.0)));
      if (!meshes_.empty() && steps == meshes_.back().steps) break;
      const MeshRung rung = measured(steps);
      if (meshes_.empty() || rung.bytes < meshes_.back().bytes) meshes_.push_back(rung);
      if (triangles < kFewestTriangles * static_cast<double>(total) || triangles < 2) break;
    }
  }

  MeshRung measured(std::size_t steps) {
    const Model level = replay(model_, record_, steps);
    const GltfOutput output = write_gltf(level, options_.binary, options_.stem, options_.write, scratch_);
    std::uint64_t bytes = 0;
    for (const OutputFile& file : output.files) bytes += file.bytes.size();
    return {steps, record_.triangles_after(steps), bytes - output.bytes.images};
  }

  void make_texture_ladder() {
    textures_.push_back(model_);
    const std::uint64_t whole = image_bytes(model_);
    if (whole == 0) return;
    ShrinkOptions shrink;
    shrink.output.format = options_.format;
    // Larger files than the budget cost most to look at, and none of them can be chosen.
    const std::uint64_t most =
        options_.bytes && !options_.whole_path ? std::min(whole, *options_.bytes) : whole;
    shrink.max_bytes = static_cast<std::int64_t>(most);
    shrink.shown_pixels = static_cast<double>(options_.view_size);
    shrinker_ = std::make_unique<TextureLadder>(model_, shrink, scratch_);
    for (double bytes = std::min(static_cast<double>(whole) * kFewerImageBytes, static_cast<double>(most));
         bytes > kFewestImageBytes * static_cast<double>(whole); bytes *= kFewerImageBytes) {
      context_.advance_or_throw("textures", 1 - bytes / static_cast<double>(whole));
      Shrunk shrunk = shrinker_->within(static_cast<std::uint64_t>(bytes), false);
      if (shrunk.bytes >= image_bytes(textures_.back())) continue;
      textures_.push_back(std::move(shrunk.model));
    }
  }

  JointLadders ladders() {
    JointLadders ladders;
    ladders.rungs = {meshes_.size(), textures_.size()};
    ladders.bytes = [this](const Rungs& rungs) { return file_bytes(rungs); };
    ladders.loss = [this](const Rungs& rungs) { return loss(combined(rungs)); };
    return ladders;
  }

  double loss(const Model& model) {
    const auto rungs = static_cast<double>(meshes_.size() + textures_.size());
    context_.advance_or_throw("fit", std::min(1.0, static_cast<double>(++drawn_) / (1.5 * rungs)));
    return pictures_.squared(model);
  }

  /// The triangles of a number of steps with the images of a model.
  Model with_images(std::size_t steps, const Model& images) const {
    Model level = replay(model_, record_, steps);
    Model result = images;
    result.meshes = std::move(level.meshes);
    return result;
  }
  Model combined(const Rungs& rungs) const {
    return with_images(meshes_[rungs[0]].steps, textures_[rungs[1]]);
  }

  FitPoint fit_point(const JointPoint& point) const {
    return {meshes_[point.rungs[0]].triangles, image_bytes(textures_[point.rungs[1]]), point.bytes,
            psnr(point.loss)};
  }

  /// Of rungs, at most.
  std::uint64_t file_bytes(const Rungs& rungs) const {
    const std::uint64_t more = rungs[1] > 0 ? json_slack(model_) : 0;
    return meshes_[rungs[0]].bytes + image_bytes(textures_[rungs[1]]) + more;
  }
  std::uint64_t file_bytes(const Model& model) {
    std::uint64_t bytes = 0;
    for (const OutputFile& file :
         write_gltf(model, options_.binary, options_.stem, options_.write, scratch_).files)
      bytes += file.bytes.size();
    return bytes;
  }

  /// The best of a point and of all sizes of images with as many triangles as fit beside them: where images
  /// come in few sizes (PNG), a single step down can be too large to be taken, and two of them worth it.
  JointPoint best_within(JointPoint best) {
    for (std::size_t t = 0; t < textures_.size(); ++t) {
      Rungs rungs{0, t};
      while (rungs[0] < meshes_.size() && file_bytes(rungs) > *options_.bytes) ++rungs[0];
      if (rungs[0] == meshes_.size() || rungs == best.rungs) continue;
      const double lost = loss(combined(rungs));
      if (lost < best.loss) best = {rungs, file_bytes(rungs), lost};
    }
    return best;
  }

  /// Tries the numbers of triangles around a point with all other bytes spent on images.
  void spend(const JointPoint& end, FitResult& result) {
    const std::uint64_t most = *options_.bytes;
    double least = end.loss;
    std::size_t rung = end.rungs[0];
    const std::size_t first = rung > 0 ? rung - 1 : 0, last = std::min(rung + 1, meshes_.size() - 1);
    for (std::size_t m = first; shrinker_ && m <= last; ++m) {
      if (meshes_[m].bytes + json_slack(model_) >= most) continue;
      const std::uint64_t room = most - meshes_[m].bytes - json_slack(model_);
      const Shrunk images = shrinker_->within(room, false);
      if (images.bytes > room) continue;
      Model tried = with_images(meshes_[m].steps, images.model);
      const double lost = loss(tried);
      if (lost >= least || file_bytes(tried) > most) continue;
      least = lost;
      rung = m;
      result.model = std::move(tried);
    }
    add_triangles(rung, result.model);
    choose_triangles(result.model);
    refine_images(result.model);
    result.chosen = {counts(result.model).triangles, image_bytes(result.model), file_bytes(result.model),
                     psnr(loss(result.model))};
  }

  /// As many triangles as there is room for, up to those of the rung above.
  void add_triangles(std::size_t rung, Model& model) {
    if (rung == 0) return;
    std::size_t enough = meshes_[rung].steps,
                few = meshes_[rung - 1].steps;  // steps that fit, and that do not
    constexpr std::size_t kFine = 64;
    while (enough > few + std::max<std::size_t>(1, enough / kFine)) {
      const std::size_t middle = few + (enough - few) / 2;
      Model tried = with_images(middle, model);
      if (file_bytes(tried) > *options_.bytes) {
        few = middle;
      } else {
        enough = middle;
        model = std::move(tried);
      }
    }
  }

  /// As many triangles, but for a few, simplified anew with pictures deciding about the last part of the way
  /// (simplify.h), if that loses less.
  void choose_triangles(Model& model) {
    std::uint64_t triangles = counts(model).triangles;
    if (triangles == record_.triangles_before) return;
    constexpr int kTries = 3;
    for (int i = 0; i < kTries; ++i) {
      SimplifyOptions simplify_options;
      simplify_options.triangles = static_cast<std::int64_t>(triangles);
      SimplifyResult simplified = simplify(model_, simplify_options, {}, scratch_);
      if (simplified.metric == Metric::quadric) return;  // as the record has them
      Model tried = model;
      tried.meshes = std::move(simplified.model.meshes);
      const std::uint64_t bytes = file_bytes(tried);
      if (bytes <= *options_.bytes) {
        if (loss(tried) < loss(model)) model = std::move(tried);
        return;
      }
      // Their vertices take a little more.
      constexpr double kMargin = 0.995;
      triangles =
          static_cast<std::uint64_t>(kMargin * static_cast<double>(triangles) *
                                     static_cast<double>(*options_.bytes) / static_cast<double>(bytes));
    }
  }

  /// The same triangles with qualities of images tried more finely, if that loses less.
  void refine_images(Model& model) {
    if (!shrinker_) return;
    const std::uint64_t images = image_bytes(model), rest = file_bytes(model) - images;
    if (rest + json_slack(model_) >= *options_.bytes) return;
    const std::uint64_t room = *options_.bytes - rest - json_slack(model_);
    const Shrunk finer = shrinker_->within(room, true);
    Model tried = finer.model;
    tried.meshes = model.meshes;
    if (finer.bytes <= room && file_bytes(tried) <= *options_.bytes && loss(tried) < loss(model))
      model = std::move(tried);
  }

  /// The last point of the path that is as like the original as asked.
  void match(const std::vector<JointPoint>& path, FitResult& result) {
    // Likeness falls along the path, all but everywhere.
    std::size_t good = 0, bad = path.size();
    result.reached = is_like(combined(path[0].rungs));
    while (result.reached && bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (is_like(combined(path[middle].rungs)) ? good : bad) = middle;
    }
    result.model = combined(path[good].rungs);
    result.chosen = result.path[good];
    result.chosen.bytes = file_bytes(result.model);
  }

  bool is_like(const Model& model) {
    const Comparison scores = pictures_.scores(model);
    ++drawn_;
    return std::ranges::all_of(scores.passes, [&](const ImageScores& s) {
      switch (options_.match) {
        case FitMetric::psnr: return s.psnr_foreground >= options_.match_value;
        case FitMetric::ms_ssim: return s.ms_ssim_foreground >= options_.match_value;
        case FitMetric::flip: return s.flip_foreground <= options_.match_value;
        case FitMetric::none: break;
      }
      return true;
    });
  }

  const Model& model_;
  const FitOptions& options_;
  Context& context_;
  Context scratch_;  // what is tried is not told
  PictureLoss pictures_;
  CollapseRecord record_;
  std::vector<MeshRung> meshes_;  // from the most triangles down
  std::vector<Model> textures_;   // from the original's images down
  std::unique_ptr<TextureLadder> shrinker_;
  std::size_t drawn_ = 0;
};

void check_options(const Model& model, const FitOptions& options) {
  if (options.bytes.has_value() == (options.match != FitMetric::none))
    throw Error(ErrorKind::usage, "a fit is to a number of bytes or to a likeness", "fit",
                "give one of --bytes and --match");
  if (counts(model).triangles == 0) throw Error(ErrorKind::unsupported, "the model has no triangles");
}

}  // namespace

OptionList describe(FitOptions& o) {
  OptionList options{
      {"triangles", "Triangles to keep at most.", &o.triangles, "triangles", 1},
      {"view-size", "Pixels along each side of the pictures that decide: how large the model will be seen.",
       &o.view_size, "pixels", 64, 4096}};
  ImageOutputOptions output;
  for (Option& option : describe(output)) {
    if (option.name != "texture-format") continue;
    option.value = choice(o.format, std::get<Option::Choice>(option.value).names);
    options.push_back(option);
  }
  return options;
}

FitResult fit(const Model& model, const FitOptions& options, Context& context) {
  check_options(model, options);
  return Fitter(model, options, context).run();
}

}  // namespace fovea
