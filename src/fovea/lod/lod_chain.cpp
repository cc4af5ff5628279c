#include "fovea/lod/lod_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/lod/lod_chain_choice.h"
#include "fovea/lod/lod_chain_error.h"
#include "fovea/render/scene.h"
#include "fovea/render/texel_density.h"
#include "fovea/simplify/metric_stage.h"

namespace fovea {

namespace {

/// Pixels along the pictures in which texels are counted.
constexpr int kDensitySize = 256;
/// Of pictures that are compared; what is smaller says nothing.
constexpr std::int64_t kSmallestPicture = 16;
/// What a search for levels may go down to.
constexpr std::int64_t kFewestTriangles = 4;

[[noreturn]] void refuse(const std::string& what, const std::string& place, const std::string& hint) {
  throw Error(ErrorKind::usage, what, place, hint);
}

template <class T>
void check_list(const std::vector<T>& list, bool rising, const char* name) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = fmt::format("--{}", name);
    if (!(list[i] > 0)) refuse(fmt::format("{} is not above 0", list[i]), place, "leave it out");
    if (i > 0 && (rising ? list[i] <= list[i - 1] : list[i] >= list[i - 1]))
      refuse(fmt::format("{} does not {} {}", list[i], rising ? "rise above" : "fall below", list[i - 1]),
             place,
             fmt::format("levels go from the finest to the coarsest: {}",
                         rising ? "distances rise" : "numbers fall"));
  }
}

void check_request(const Model& model, LodChainOptions options) {
  OptionList list = describe(options);
  for (Option& option : describe(options.screen)) list.push_back(option);
  check(list);
  check_list(options.triangles, false, "triangles");
  check_list(options.coverages, false, "coverage");
  check_list(options.distances, true, "distances");
  check_list(options.bytes, false, "bytes");
  if (!options.bytes.empty() && options.bytes.size() != options.triangles.size())
    refuse("there are not as many numbers of bytes as of triangles", "--bytes", "give one for each level");
  if (options.simplify.per_mesh)
    refuse("levels cannot be read off meshes simplified one by one", "--per-mesh", "leave it out");
  if (std::ranges::find(model.extensions_used, "MSFT_lod") != model.extensions_used.end())
    throw Error(ErrorKind::unsupported, "the model has levels of detail already (MSFT_lod)", "",
                "give the model that they were made of");
}

void check_distances(const std::vector<double>& distances, double radius, const LodScreen& screen) {
  if (distances.empty() || distances.front() > radius) return;
  refuse(fmt::format("the eye would be inside the model's bounding sphere (radius {:.4g}) at distance {:.4g}",
                     radius, distances.front()),
         "the first level's distance",
         fmt::format("begin farther away: beyond a distance of {:.4g}, below a coverage of {:.4g}", radius,
                     coverage_at(radius, radius, screen)));
}

/// Down to the coarsest level; see `make_lod_chain` for what decides.
SimplifyOptions simplify_options(const LodChainOptions& options, const std::vector<std::uint64_t>& targets,
                                 std::uint64_t total) {
  SimplifyOptions simple = options.simplify;
  simple.ratio = simple.error = simple.error_abs = std::nullopt;
  if (targets.empty()) {
    simple.triangles = kFewestTriangles;
    if (simple.metric == Metric::automatic) simple.metric = Metric::quadric;
    return simple;
  }
  const std::uint64_t last = targets.back(),
                      before = targets.size() > 1 ? targets[targets.size() - 2] : total;
  simple.triangles = static_cast<std::int64_t>(last);
  // Distances follow from the largest errors.
  if (simple.metric == Metric::automatic) simple.even_exposure = true;
  if (simple.metric == Metric::automatic && last > 0)
    simple.metric_from = std::clamp(static_cast<double>(before) / static_cast<double>(last), 1.0, 2.0);
  return simple;
}

class ChainMaker {
 public:
  ChainMaker(const Model& model, const LodChainOptions& options, Context& context)
      : model_(model), options_(options), context_(context) {}

  LodChain run(const Importance& importance) {
    look_at_original();
    const std::vector<double> distances = lod_distances(options_, chain_.sphere.radius);
    check_distances(distances, chain_.sphere.radius, options_.screen);
    const SimplifyResult result = simplified(importance);
    const std::vector<LodChoice> choices =
        rising(choose(result.record, distances), result.triangles_before, context_);
    add_original(result.triangles_before);
    for (std::size_t i = 0; i < choices.size(); ++i) {
      context_.advance_or_throw("levels", static_cast<double>(i) / static_cast<double>(choices.size()));
      add_level(result.record, choices[i]);
    }
    context_.advance_or_throw("levels", 1);
    return std::move(chain_);
  }

 private:
  void look_at_original() {
    const Pose pose = rest_pose(model_);
    const RenderScene scene = make_render_scene(model_, pose, context_, nullptr, SceneTextures::none);
    if (scene.triangle_count == 0)
      throw Error(ErrorKind::unsupported, "the model shows no triangles to simplify");
    chain_.sphere = scene.sphere;
    chain_.diagonal = diagonal(triangles_of(scene));
    chain_.screen = options_.screen;
    if (options_.textures_follow && !model_.images.empty())
      densities_ =
          texel_densities(model_, scene, views_of({}, model_, pose, scene.sphere), kDensitySize, context_);
  }

  SimplifyResult simplified(const Importance& importance) {
    std::uint64_t total = 0;
    for (const Mesh& mesh : model_.meshes) total += mesh.surface.face_count();
    targets_ = lod_targets(options_, total);
    SimplifyResult result =
        options_.record != nullptr
            ? known(*options_.record)
            : simplify(model_, simplify_options(options_, targets_, total), importance, context_);
    if (result.stop == StopReason::cancelled) throw Error(ErrorKind::cancelled, "cancelled");
    chain_.reached = targets_.empty() || result.triangles_after <= targets_.back();
    chain_.metric = result.metric;
    chain_.metric_from = result.metric_from;
    return result;
  }

  static SimplifyResult known(const CollapseRecord& record) {
    SimplifyResult result;
    result.record = record;
    result.triangles_before = record.triangles_before;
    result.triangles_after = record.triangles_after(record.steps.size());
    return result;
  }

  std::vector<LodChoice> choose(const CollapseRecord& record, const std::vector<double>& distances) {
    LodReference reference(model_, options_.key_poses, options_.distance_samples, context_);
    LodMeasure measure(model_, record, reference, context_);
    const double radius = chain_.sphere.radius;
    const double count = static_cast<double>(std::max(targets_.size(), distances.size()));
    std::vector<LodChoice> choices;
    const auto tell = [&] {
      context_.advance_or_throw("measure", static_cast<double>(choices.size()) / count);
    };
    for (const std::uint64_t target : targets_) {
      tell();
      choices.push_back(measure.at(target));
      if (!options_.bytes.empty()) choices.back().bytes = options_.bytes[choices.size() - 1];
      choices.back().distance = switch_distance(choices.back().error.max, radius, options_.screen);
    }
    for (const double distance : distances) {
      tell();
      choices.push_back(measure.simplest(length_at(distance, radius, options_.screen)));
      choices.back().distance = distance;
    }
    return choices;
  }

  void add_original(std::uint64_t triangles) {
    LodLevel& level = chain_.levels.emplace_back();
    level.model = model_;
    level.triangles = triangles;
  }

  void add_level(const CollapseRecord& record, const LodChoice& choice) {
    LodLevel& level = chain_.levels.emplace_back();
    level.model = replay(model_, record, choice.steps);
    level.triangles = choice.triangles;
    level.error = choice.error;
    level.distance = choice.distance;
    level.most_bytes = choice.bytes;
    level.coverage = coverage_at(choice.distance, chain_.sphere.radius, options_.screen);
    level.pixels = pixels_at(choice.distance, choice.error.max, chain_.sphere.radius, options_.screen);
    const double height = level.coverage * static_cast<double>(options_.screen.height);
    if (!densities_.empty()) shrink(level, height, choice.bytes);
    if (options_.pictures) take_pictures(level, height);
  }

  void shrink(LodLevel& level, double height, std::uint64_t bytes) {
    ShrinkOptions options = options_.textures;
    options.max_bytes = std::nullopt;
    if (bytes > 0) {
      options.shown_pixels = height;
    } else {
      options.scales = needed_scales(densities_, height);
    }
    Shrunk shrunk = bytes > 0
                        ? shrink_textures_within(level.model, bytes, options_.form, options, {}, context_)
                        : shrink_textures(level.model, options, {}, context_);
    level.model = std::move(shrunk.model);
    level.images = std::move(shrunk.images);
  }

  void take_pictures(LodLevel& level, double height) {
    CompareOptions options;
    options.distance_samples = 0;
    options.size = std::clamp<std::int64_t>(std::llround(height), kSmallestPicture, options_.screen.height);
    const Model* test = &level.model;
    level.pictures = compare(model_, {&test, 1}, options, context_).front().passes;
    level.picture_size = options.size;
  }

  const Model& model_;
  const LodChainOptions& options_;
  Context& context_;
  std::vector<std::uint64_t> targets_;
  std::vector<TexelDensity> densities_;  // empty if textures stay
  LodChain chain_;
};

}  // namespace

OptionList describe(LodChainOptions& o) {
  return {
      {"levels", "Number of levels, the original among them.", &o.levels, "", 2, 32},
      {"ratio", "Part of the triangles of the level before that each level keeps.", &o.ratio, "", 0.01, 0.99},
      {"key-poses",
       "Poses of animations and morph targets in which errors are measured on all points, besides the one at "
       "rest; on some points they are in all poses. 0: at rest alone.",
       &o.key_poses, "", 0, 64},
      {"distance-samples", "Points on each surface for the distance between them.", &o.distance_samples, "",
       100, 1e8},
  };
}

LodChain make_lod_chain(const Model& model, const LodChainOptions& options, const Importance& importance,
                        Context& context) {
  check_request(model, options);
  return ChainMaker(model, options, context).run(importance);
}

}  // namespace fovea
