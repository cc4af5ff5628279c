#include "fovea/budget/fit_ladders.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/budget/camera_sights.h"
#include "fovea/io/gltf_read.h"
#include "fovea/io/gltf_write.h"

namespace fovea {

namespace {

/// More meshes or images than this have one ladder together.
constexpr std::size_t kMostLadders = 8;

/// Of a rung, in parts of the usual one before it.
constexpr double kFewerImageBytes = 0.6;

/// Bytes of JSON that come at most when images get other sizes and formats (EXT_texture_webp).
std::uint64_t json_slack(const Model& model) {
  constexpr std::uint64_t kOnce = 128, kForEach = 96;
  return kOnce + kForEach * (model.images.size() + model.textures.size());
}

std::uint64_t image_bytes_of(const Model& model) {
  std::uint64_t sum = 0;
  for (const EncodedImage& image : model.images) sum += image.bytes.size();
  return sum;
}

/// From rung to rung on ladders as fine as asked.
double fewer_of(double usual, const FitOptions& options) {
  return std::pow(usual, 1.0 / static_cast<double>(options.fineness));
}

MeshLadderOptions mesh_options(const Model& model, const FitOptions& options) {
  std::size_t meshes = 0;
  for (const Mesh& mesh : model.meshes) meshes += mesh.surface.face_count() > 0;
  MeshLadderOptions result{options.triangles, options.gives == FitGives::texels,
                           options.ladders == FitLadderSet::separate && meshes <= kMostLadders};
  result.fewer = fewer_of(result.fewer, options);
  if (options.views.set == ViewSet::cameras) result.cameras = options.views;
  return result;
}

}  // namespace

FitLadders::FitLadders(const Model& model, const FitOptions& options, Context& context)
    : model_(model),
      options_(options),
      context_(context),
      pictures_(model, options.views, static_cast<int>(options.view_size), options.distortion, context),
      meshes_(model, mesh_options(model, options), options.form, context) {
  scratch_.threads = context.threads;
  scratch_.seed = context.seed;
  scratch_.progress = [this](std::string_view, double) { return is_finishing_ || !context_.cancelled(); };
  if (options.gives != FitGives::triangles && image_bytes_of(model) > 0) make_image_ladders(options);
  expected_ = 12;
  const JointLadders all = joint();
  for (const std::size_t rungs : all.rungs) expected_ += rungs + rungs / 2;
}

void FitLadders::make_image_ladders(const FitOptions& options) {
  TextureLadderOptions ladder;
  ladder.output.format = options.format;
  ladder.shown_pixels = static_cast<double>(options.view_size);
  ladder.most_bytes = options.most_bytes;
  context_.advance_or_throw("textures", 0);
  if (options.views.set == ViewSet::cameras) {
    const Pose pose = rest_pose(model_);
    const RenderScene scene = make_render_scene(model_, pose, scratch_);
    viewers_ = camera_sights(model_, scene, views_of(options.views, model_, pose, scene.sphere),
                             static_cast<int>(options.view_size), scratch_);
    ladder.viewers = &*viewers_;
  }
  textures_ = std::make_unique<TextureLadders>(model_, ladder, scratch_);
  make_image_levels();
  const auto& rungs = textures_->rungs();
  std::vector<std::size_t> changing;
  for (std::size_t i = 0; i < rungs.size(); ++i)
    if (rungs[i].size() > 1) changing.push_back(i);
  if (options.ladders == FitLadderSet::separate && changing.size() <= kMostLadders) {
    const auto all = static_cast<double>(image_bytes_of(model_));
    for (const std::size_t i : changing) {
      ImageLadder& own = image_ladders_.emplace_back(ImageLadder{{i}, {}});
      // Of what is small anyway larger steps will do.
      const double share = static_cast<double>(rungs[i][0].bytes) / all;
      const double fewer = std::pow(fewer_of(kFewerImageBytes, options), share > 1.0 / 8    ? 1
                                                                         : share > 1.0 / 32 ? 2
                                                                                            : 3);
      double last = INFINITY;
      for (const TextureRung& rung : rungs[i]) {
        const auto bytes = static_cast<double>(rung.bytes);
        const bool is_end = &rung == &rungs[i].back();
        if (bytes > fewer * last && !is_end) continue;
        own.ways.push_back({rung.way});
        last = bytes;
      }
    }
    return;
  }
  ImageLadder& own = image_ladders_.emplace_back();
  own.images.resize(model_.images.size());
  std::iota(own.images.begin(), own.images.end(), std::size_t{0});
  own.ways = image_levels_;
}

void FitLadders::make_image_levels() {
  image_levels_.push_back(std::vector<std::size_t>(model_.images.size(), TextureLadders::kAsItIs));
  const std::uint64_t whole = image_bytes_of(model_);
  const std::uint64_t most = options_.most_bytes > 0 ? std::min(whole, options_.most_bytes) : whole;
  const double fewer = fewer_of(kFewerImageBytes, options_);
  const std::uint64_t fewest = image_bytes({{}, textures_->within(0, false)});
  std::uint64_t last = whole;
  // At the latest where that is less than the fewest, they are chosen.
  for (double bytes = std::min(static_cast<double>(whole) * fewer, static_cast<double>(most)); last > fewest;
       bytes *= fewer) {
    context_.advance_or_throw("textures", 1 - bytes / static_cast<double>(whole));
    std::vector<std::size_t> ways = textures_->within(static_cast<std::uint64_t>(bytes), false);
    const std::uint64_t taken = image_bytes({{}, ways});
    if (taken >= last) continue;
    last = taken;
    image_levels_.push_back(std::move(ways));
  }
}

JointLadders FitLadders::joint() {
  JointLadders ladders;
  for (const auto& rungs : meshes_.rungs()) ladders.rungs.push_back(rungs.size());
  for (const ImageLadder& own : image_ladders_) ladders.rungs.push_back(own.ways.size());
  ladders.bytes = [this](const Rungs& rungs) { return bytes(choice(rungs)); };
  ladders.loss = [this](const Rungs& rungs) { return loss(choice(rungs)).value; };
  return ladders;
}

FitChoice FitLadders::choice(const Rungs& rungs) const {
  FitChoice choice;
  const std::size_t meshes = meshes_.rungs().size();
  for (std::size_t l = 0; l < meshes; ++l) choice.steps.push_back(meshes_.rungs()[l][rungs[l]].steps);
  choice.ways.assign(model_.images.size(), TextureLadders::kAsItIs);
  for (std::size_t l = 0; l < image_ladders_.size(); ++l) {
    const ImageLadder& own = image_ladders_[l];
    const std::vector<std::size_t>& ways = own.ways[rungs[meshes + l]];
    for (std::size_t i = 0; i < ways.size(); ++i) choice.ways[own.images[i]] = ways[i];
  }
  return choice;
}

double FitLadders::mesh_bytes(const FitChoice& choice) const {
  double sum = 0;
  for (std::size_t l = 0; l < choice.steps.size(); ++l) sum += meshes_.bytes(l, choice.steps[l]);
  return sum;
}

std::uint64_t FitLadders::image_bytes(const FitChoice& choice) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < choice.ways.size(); ++i) {
    sum += choice.ways[i] == TextureLadders::kAsItIs ? model_.images[i].bytes.size()
                                                     : textures_->bytes(i, choice.ways[i]);
  }
  return sum;
}

std::uint64_t FitLadders::bytes(const FitChoice& choice) {
  constexpr std::uint64_t kDigits = 64;  // of counts and offsets, where several meshes change
  const bool is_changed =
      std::ranges::any_of(choice.ways, [](std::size_t way) { return way != TextureLadders::kAsItIs; });
  return meshes_.rest_bytes() + static_cast<std::uint64_t>(std::ceil(mesh_bytes(choice))) +
         image_bytes(choice) + (is_changed ? json_slack(model_) : 0) +
         (choice.steps.size() > 1 ? kDigits * choice.steps.size() : 0);
}

std::vector<std::size_t> FitLadders::steps_within(const std::vector<std::size_t>& steps, double bytes) const {
  std::vector<double> now;
  for (std::size_t l = 0; l < steps.size(); ++l) now.push_back(meshes_.bytes(l, steps[l]) + 1);
  const auto at = [&](double scale) {
    std::vector<std::size_t> scaled;
    for (std::size_t l = 0; l < steps.size(); ++l) scaled.push_back(meshes_.steps_within(l, scale * now[l]));
    return scaled;
  };
  const auto taken = [&](const std::vector<std::size_t>& scaled) { return mesh_bytes({scaled, {}}); };
  constexpr double kMost = 1e6;
  constexpr int kHalvings = 60;
  double low = 0, high = kMost;
  if (taken(at(high)) <= bytes) return at(high);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = low > 0 ? std::sqrt(low * high) : high / kMost;
    (taken(at(middle)) <= bytes ? low : high) = middle;
    if (low == 0 && high < 1 / kMost) break;
  }
  return at(low);
}

Model FitLadders::model(const FitChoice& choice) {
  Model model = meshes_.level(choice.steps);
  set_images(model, choice.ways);
  return model;
}

void FitLadders::set_images(Model& model, const std::vector<std::size_t>& ways) {
  for (std::size_t i = 0; i < ways.size(); ++i)
    model.images[i] = ways[i] == TextureLadders::kAsItIs ? model_.images[i] : textures_->stored(i, ways[i]);
}

std::uint64_t FitLadders::file_bytes(const Model& model) {
  return written_bytes(model, options_.form, scratch_).total();
}

PictureLoss::Loss FitLadders::loss(const FitChoice& choice) {
  const auto [at, is_new] = known_.try_emplace(choice);
  if (is_new) {
    try {
      at->second = loss(model(choice));
    } catch (...) {
      known_.erase(at);
      throw;
    }
  }
  return at->second;
}

PictureLoss::Loss FitLadders::loss(const Model& model) {
  context_.advance_or_throw("fit",
                            std::min(0.99, static_cast<double>(++drawn_) / static_cast<double>(expected_)));
  return pictures_.of(model);
}

Comparison FitLadders::scores(const Model& model) {
  constexpr bool kBinary = true;
  const std::vector<OutputFile> files =
      write_gltf(model, kBinary, options_.form.stem, options_.form.write, scratch_).files;
  return pictures_.scores(read_gltf(files.front().bytes, {}, options_.form.stem, ReadOptions(), scratch_));
}

}  // namespace fovea
