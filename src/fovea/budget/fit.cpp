#include "fovea/budget/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/budget/fit_ladders.h"
#include "fovea/budget/marginal.h"
#include "fovea/model/image_error.h"
#include "fovea/simplify/simplify.h"
#include "fovea/texture/image_ways.h"

namespace fovea {

namespace {

/// Rungs that pruning looks down at once: what a rung loses is not even, and some are worse than the next. Of
/// finer ladders those of images want more: with two MaterialsVariantsShoe was 0.39 dB behind the best at a
/// point, with three 0.03, and three of meshes gain nothing.
constexpr std::size_t kAhead = 2, kAheadOfFinerImages = 3;

void check_options(const Model& model, const FitOptions& options) {
  if (counts(model).triangles == 0) throw Error(ErrorKind::unsupported, "the model has no triangles");
  if (options.triangles && *options.triangles < 1)
    throw Error(ErrorKind::usage, "there are fewer than one triangle to keep", "triangles");
}

FitOptions prepared(FitOptions options) {
  // All pairs are few only of two ladders.
  if (options.search == FitSearch::exhaustive) options.ladders = FitLadderSet::joint;
  return options;
}

void check_likeness(FitMetric metric, double value) {
  const double most = metric == FitMetric::psnr ? std::numeric_limits<double>::max() : 1;
  if (!(value >= 0 && value <= most))
    throw Error(ErrorKind::usage, "no likeness has this value", "match", "MS-SSIM and FLIP are from 0 to 1");
}

}  // namespace

class BudgetFit::Finder {
 public:
  Finder(const Model& model, const FitOptions& options, Context& context)
      : options_(prepared(options)), ladders_(model, options_, context), weights_(model.images.size(), 1.0) {}

  FitResult within(std::uint64_t bytes) {
    FitResult result;
    bytes_ = bytes;
    best_.reset();
    for (std::size_t i = 0; i < weights_.size(); ++i) set_weight(i, 1);
    try {
      find(result);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::cancelled) throw;
      ladders_.finish_up();
      if (!best_ && !guess()) throw;
      result.cancelled = true;
      result.reached = true;
    }
    result.chosen = point(*best_);
    result.model = std::move(best_->model);
    result.pictures = ladders_.pictures_drawn();
    return result;
  }

  FitResult like(FitMetric metric, double value) {
    check_likeness(metric, value);
    const auto is_like = [&](const Model& model) { return this->is_like(model, metric, value); };
    const std::vector<JointPoint> path = walk_while(is_like);
    FitResult result;
    // Likeness falls along the path, all but everywhere.
    std::size_t good = 0, bad = path.size();
    const auto at = [&](std::size_t i) { return ladders_.model(ladders_.choice(path[i].rungs)); };
    const bool reached = is_like(at(0));
    while (reached && bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (is_like(at(middle)) ? good : bad) = middle;
    }
    const FitChoice choice = ladders_.choice(path[good].rungs);
    Best best{choice, at(good), ladders_.loss(choice)};
    if (reached && bad < path.size()) {
      // Between the two points fewer bytes may do.
      constexpr std::uint64_t kNear = 16;  // parts of the bytes
      std::uint64_t least = path[bad].bytes / 2, most = ladders_.file_bytes(best.model);
      while (most - std::min(most, least) > most / kNear) {
        FitResult tried = within(least + (most - least) / 2);
        if (tried.cancelled) throw Error(ErrorKind::cancelled, "cancelled");
        if (tried.reached && is_like(tried.model)) {
          best = {best_->choice, std::move(tried.model), best_->loss};
          most = ladders_.file_bytes(best.model);
        } else {
          least += (most - least) / 2;
        }
      }
    }
    for (const JointPoint& point : path) result.path.push_back(this->point(point));
    result.reached = reached;
    result.chosen = point(best);
    result.model = std::move(best.model);
    result.pictures = ladders_.pictures_drawn();
    return result;
  }

  std::vector<FitPoint> way() {
    way_ = walk(0);
    std::vector<FitPoint> points;
    for (const JointPoint& point : way_) points.push_back(this->point(point));
    return points;
  }

  std::vector<FitPoint> all() {
    std::vector<FitPoint> points;
    for (const JointPoint& point : all_) points.push_back(this->point(point));
    return points;
  }

  Model at(std::size_t point) { return ladders_.model(ladders_.choice(way_.at(point).rungs)); }

 private:
  struct Best {
    FitChoice choice;
    Model model;
    PictureLoss::Loss loss;
  };

  FitPoint point(const JointPoint& point) {
    const FitChoice choice = ladders_.choice(point.rungs);
    const PictureLoss::Loss loss = ladders_.loss(choice);
    return {ladders_.meshes().triangles(choice.steps), ladders_.image_bytes(choice), point.bytes, loss.value,
            psnr(loss.squared)};
  }

  FitPoint point(const Best& best) {
    std::uint64_t images = 0;
    for (const EncodedImage& image : best.model.images) images += image.bytes.size();
    return {counts(best.model).triangles, images, ladders_.file_bytes(best.model), best.loss.value,
            psnr(best.loss.squared)};
  }

  /// Points from the original down, the last within the bytes if there is one.
  std::vector<JointPoint> walk(std::uint64_t bytes) {
    JointLadders joint = ladders_.joint();
    if (options_.search == FitSearch::exhaustive) {
      if (all_.empty()) all_ = exhaust(joint);
      return lower_hull(all_);
    }
    if (options_.search == FitSearch::prune) {
      std::vector<JointPoint> drawn;
      joint.loss = [&, loss = std::move(joint.loss)](const Rungs& rungs) {
        drawn.push_back({rungs, joint.bytes(rungs), loss(rungs)});
        return drawn.back().loss;
      };
      std::vector<std::size_t> ahead(joint.rungs.size(),
                                     options_.fineness > 1 ? kAheadOfFinerImages : kAhead);
      std::fill_n(ahead.begin(), ladders_.meshes().rungs().size(), kAhead);
      const std::vector<JointPoint> path = prune(joint, bytes, ahead);
      return best_of(std::move(drawn), path, bytes);
    }
    std::vector<JointPoint> path = grow(joint, bytes > 0 ? bytes : std::numeric_limits<std::uint64_t>::max());
    std::ranges::reverse(path);
    return path;
  }

  /// The hull of all that a path came by, between its ends; within the bytes, what loses least.
  static std::vector<JointPoint> best_of(std::vector<JointPoint> drawn, const std::vector<JointPoint>& path,
                                         std::uint64_t bytes) {
    JointPoint end = path.back();
    for (const JointPoint& point : drawn)
      if (point.bytes <= bytes && point.loss < end.loss) end = point;
    std::erase_if(drawn, [&](const JointPoint& point) { return point.bytes < end.bytes; });
    std::vector<JointPoint> best = lower_hull(std::move(drawn));
    if (best.front().rungs != path.front().rungs) best.insert(best.begin(), path.front());
    return best;
  }

  /// The way down to half the bytes, a quarter, and so on, until its end is no longer like.
  std::vector<JointPoint> walk_while(const std::function<bool(const Model&)>& is_like) {
    if (options_.search != FitSearch::prune) return walk(0);
    std::vector<JointPoint> path = walk(std::numeric_limits<std::uint64_t>::max());
    for (std::uint64_t bytes = path.front().bytes / 2;; bytes /= 2) {
      path = walk(bytes);
      const bool is_end = path.back().bytes > bytes || bytes == 0;
      if (is_end || !is_like(ladders_.model(ladders_.choice(path.back().rungs)))) return path;
    }
  }

  /// Of `walk`, and of all points if all were measured, the best within the bytes.
  std::optional<JointPoint> end_of(const std::vector<JointPoint>& path) const {
    std::optional<JointPoint> best;
    for (const std::vector<JointPoint>* points : {&path, &all_}) {
      for (const JointPoint& point : *points)
        if (point.bytes <= bytes_ && (!best || point.loss < best->loss)) best = point;
    }
    return best;
  }

  void find(FitResult& result) {
    const std::vector<JointPoint> path = walk(bytes_);
    for (const JointPoint& point : path) result.path.push_back(this->point(point));
    const std::optional<JointPoint> end = end_of(path);
    if (end) consider(ladders_.choice(end->rungs));
    if (best_ && best_->choice == ladders_.whole()) return;
    try_image_levels();
    result.reached = best_.has_value();
    if (!result.reached) {
      take_smallest();
      result.reached = ladders_.file_bytes(best_->model) <= bytes_;  // estimates are a little more
      return;
    }
    if (ladders_.textures() != nullptr) {
      // Qualities near what is chosen, so that shares find what fits them.
      ladders_.textures()->within(bytes_for_images(best_->model), true);
      try_shares();
      try_halves();
      try_weights();
    }
    // More triangles of the record can look no better, and yet do once pictures choose them.
    const std::uint64_t most = counts(ladders_.model(add_triangles())).triangles;
    const std::uint64_t best = counts(best_->model).triangles;
    choose_triangles(best);
    if (most > best) choose_triangles(most);
    refine_images();
  }

  /// Takes a choice that loses less than the best so far, with fewer triangles if it must to keep to the
  /// bytes.
  void consider(FitChoice choice) {
    if (!keeps_to_bytes(choice)) return;
    if (best_ && ladders_.loss(choice).value >= best_->loss.value) return;
    Model model = ladders_.model(choice);
    constexpr int kTries = 4;
    for (int i = 0; i < kTries; ++i) {
      const std::uint64_t taken = ladders_.file_bytes(model);
      if (taken <= bytes_) {
        const PictureLoss::Loss loss = ladders_.loss(choice);
        if (!best_ || loss.value < best_->loss.value) best_ = Best{choice, std::move(model), loss};
        return;
      }
      const double excess = static_cast<double>(taken - bytes_) * (1 << i) + 64;
      choice.steps = ladders_.steps_within(choice.steps, ladders_.mesh_bytes(choice) - excess);
      model = ladders_.model(choice);
    }
  }

  /// By estimate; takes triangles off if they are too many.
  bool keeps_to_bytes(FitChoice& choice) {
    const std::uint64_t taken = ladders_.bytes(choice);
    if (taken <= bytes_) return true;
    const double room = ladders_.mesh_bytes(choice) - static_cast<double>(taken - bytes_);
    if (room < 0) return false;
    choice.steps = ladders_.steps_within(choice.steps, room - 1);
    return ladders_.bytes(choice) <= bytes_;
  }

  /// Without pictures: half of the bytes for images.
  bool guess() {
    for (const std::vector<std::size_t>& ways : ladders_.image_levels()) {
      FitChoice choice = ladders_.whole();
      choice.ways = ways;
      if (2 * ladders_.image_bytes(choice) > bytes_ && &ways != &ladders_.image_levels().back()) continue;
      if (!keeps_to_bytes(choice)) continue;
      Model model = ladders_.model(choice);
      if (ladders_.file_bytes(model) > bytes_) continue;
      constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
      best_ = Best{choice, std::move(model), {kUnknown, kUnknown}};
      return true;
    }
    return false;
  }

  void take_smallest() {
    const JointLadders joint = ladders_.joint();
    Rungs last;
    for (const std::size_t rungs : joint.rungs) last.push_back(rungs - 1);
    const FitChoice choice = ladders_.choice(last);
    best_ = Best{choice, ladders_.model(choice), ladders_.loss(choice)};
  }

  /// All sizes of all images together with as many triangles as fit beside them: where images come in few
  /// sizes (PNG), a single step down can be too large to be taken, and two of them worth it.
  void try_image_levels() {
    // Not what is far from the best so far.
    constexpr std::uint64_t kFar = 3;
    const std::uint64_t now = best_ ? ladders_.image_bytes(best_->choice) : 0;
    for (const std::vector<std::size_t>& ways : ladders_.image_levels()) {
      FitChoice choice = ladders_.whole();
      choice.ways = ways;
      const std::uint64_t taken = ladders_.image_bytes(choice);
      if (best_ && (taken > kFar * now || taken * kFar < now)) continue;
      if (!fewest_steps(choice)) continue;
      consider(std::move(choice));
    }
  }

  /// Sets the first steps of the whole simplification, as few as the bytes allow. False if none are enough.
  bool fewest_steps(FitChoice& choice) {
    const MeshLadders& meshes = ladders_.meshes();
    std::size_t least = 0, most = meshes.step_count();
    const auto fits = [&](std::size_t count) {
      choice.steps = meshes.first_steps(count);
      return ladders_.bytes(choice) <= bytes_;
    };
    if (!fits(most)) return false;
    while (least < most) {
      const std::size_t middle = least + (most - least) / 2;
      if (fits(middle)) {
        most = middle;
      } else {
        least = middle + 1;
      }
    }
    return fits(most);
  }

  /// More and fewer triangles than the best has, with all other bytes spent on images.
  void try_shares() {
    const FitChoice base = best_->choice;
    try_share(base, 1);
    for (const double step : {0.8, 1.25}) {
      bool gains = false;
      for (double share = step; share > 0.2 && share < 5 && try_share(base, share); share *= step)
        gains = true;
      if (gains) return;  // there is nothing on the other side then
    }
  }

  /// What images get beside this share of the triangles' bytes; nothing if that leaves them none.
  double room_beside(const FitChoice& base, const FitChoice& choice) {
    const double room = static_cast<double>(bytes_) - ladders_.mesh_bytes(choice) +
                        ladders_.mesh_bytes(base) + static_cast<double>(ladders_.image_bytes(base)) -
                        static_cast<double>(ladders_.bytes(base));
    return std::max(room, 0.0);
  }

  /// Whether it is better than the best so far.
  bool try_share(const FitChoice& base, double share) {
    TextureLadders& textures = *ladders_.textures();
    const double before = best_->loss.value;
    FitChoice choice = base;
    choice.steps = ladders_.steps_within(base.steps, share * ladders_.mesh_bytes(base));
    const double room = room_beside(base, choice);
    if (room <= 0) return false;
    // As estimates have it; and with what pictures chose as the least.
    const std::vector<std::size_t> wanted = textures.within(static_cast<std::uint64_t>(room), false);
    choice.ways = wanted;
    consider(choice);
    if (options_.ladders == FitLadderSet::separate &&
        static_cast<double>(ladders_.image_bytes(base)) <= room) {
      choice.ways = textures.filled(base.ways, static_cast<std::uint64_t>(room));
      if (choice.ways != wanted) consider(choice);
    }
    return best_->loss.value < before;
  }

  /// The sides of all images halved alike, as somebody would who measures nothing: estimates can be wrong
  /// about which image wants large sides rather than high quality.
  void try_halves() {
    const FitChoice base = best_->choice;
    const auto room = static_cast<std::uint64_t>(room_beside(base, base));
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
      FitChoice choice = base;
      choice.ways = ladders_.textures()->halved(room, halvings);
      if (choice.ways.empty()) continue;
      const std::uint64_t taken = ladders_.image_bytes(choice);
      if (taken <= room && choice.ways != base.ways) consider(std::move(choice));
      if (taken < room / 2) return;  // fewer texels only lose more
    }
  }

  /// Bytes moved from some images to others, as pictures want it: estimates do not know what light makes of
  /// them.
  void try_weights() {
    TextureLadders* const textures = ladders_.textures();
    constexpr std::size_t kMostImages = 8;
    std::vector<std::size_t> images;
    for (std::size_t i = 0; i < textures->rungs().size(); ++i)
      if (textures->rungs()[i].size() > 1) images.push_back(i);
    if (images.size() < 2) return;
    std::ranges::stable_sort(images, std::greater(),
                             [&](std::size_t i) { return textures->rungs()[i].front().bytes; });
    images.resize(std::min(images.size(), kMostImages));
    for (const std::size_t image : images) {
      for (const double factor : {4.0, 0.25}) {
        const FitChoice base = best_->choice;
        const double before = best_->loss.value;
        const double weight = weights_[image];
        set_weight(image, weight * factor);
        FitChoice choice = base;
        choice.ways = textures->within(static_cast<std::uint64_t>(room_beside(base, base)), false);
        if (choice.ways != base.ways) consider(choice);
        if (best_->loss.value < before) break;
        set_weight(image, weight);
      }
    }
  }

  void set_weight(std::size_t image, double weight) {
    if (weights_[image] == weight) return;
    weights_[image] = weight;
    ladders_.textures()->set_weight(image, weight);
  }

  /// As many triangles as there is room for; also returned where they look no better.
  FitChoice add_triangles() {
    const std::uint64_t taken = ladders_.file_bytes(best_->model);
    const double now = ladders_.mesh_bytes(best_->choice);
    double enough = now, most = now + static_cast<double>(bytes_ - taken);
    constexpr int kTries = 6;
    FitChoice best = best_->choice;
    for (int i = 0; i < kTries; ++i) {
      // The estimate first: it is mostly right.
      const double tried = i == 0 ? most : (enough + most) / 2;
      FitChoice choice = best_->choice;
      choice.steps = ladders_.steps_within(best_->choice.steps, tried);
      if (choice.steps == best.steps) break;
      if (ladders_.file_bytes(ladders_.model(choice)) <= bytes_) {
        best = std::move(choice);
        enough = tried;
        if (i == 0) break;
      } else {
        most = tried;
      }
    }
    if (best != best_->choice && ladders_.loss(best).value < best_->loss.value)
      best_ = Best{best, ladders_.model(best), ladders_.loss(best)};
    return best;
  }

  void take_if_better(Model model) {
    if (ladders_.file_bytes(model) > bytes_) return;
    const PictureLoss::Loss loss = ladders_.loss(model);
    if (loss.value < best_->loss.value) best_ = Best{best_->choice, std::move(model), loss};
  }

  /// So many triangles, but for a few, simplified anew with pictures deciding about the last part of the way
  /// (simplify.h).
  void choose_triangles(std::uint64_t triangles) {
    if (options_.gives == FitGives::texels) return;
    if (triangles == counts(ladders_.original()).triangles) return;
    constexpr int kTries = 3;
    for (int i = 0; i < kTries && triangles > 0; ++i) {
      SimplifyOptions simplify_options;
      simplify_options.triangles = static_cast<std::int64_t>(triangles);
      if (options_.views.set == ViewSet::cameras) simplify_options.views = options_.views;
      SimplifyResult simplified = simplify(ladders_.original(), simplify_options, {}, ladders_.scratch());
      if (simplified.stop == StopReason::cancelled) throw Error(ErrorKind::cancelled, "cancelled");
      if (simplified.metric == Metric::quadric) return;  // as the record has them
      Model model = best_->model;
      model.meshes = std::move(simplified.model.meshes);
      const std::uint64_t bytes = ladders_.file_bytes(model);
      if (bytes <= bytes_) return take_if_better(std::move(model));
      // Their vertices take a little more.
      constexpr double kMargin = 0.995;
      triangles = static_cast<std::uint64_t>(kMargin * static_cast<double>(triangles) *
                                             static_cast<double>(bytes_) / static_cast<double>(bytes));
    }
  }

  /// What a model's triangles leave.
  std::uint64_t bytes_for_images(const Model& model) {
    std::uint64_t images = 0;
    for (const EncodedImage& image : model.images) images += image.bytes.size();
    return bytes_ - (ladders_.file_bytes(model) - images);
  }

  /// The same triangles with qualities of images tried more finely.
  void refine_images() {
    TextureLadders* const textures = ladders_.textures();
    if (textures == nullptr) return;
    const std::uint64_t room = bytes_for_images(best_->model);
    const std::vector<std::size_t> before = best_->choice.ways;
    const std::array<std::vector<std::size_t>, 2> tried{textures->within(room, true),
                                                        textures->filled(before, room)};
    for (const std::vector<std::size_t>& ways : tried) {
      if (ways == best_->choice.ways) continue;
      Model model = best_->model;
      ladders_.set_images(model, ways);
      take_if_better(std::move(model));
    }
  }

  bool is_like(const Model& model, FitMetric metric, double value) {
    const Comparison scores = ladders_.scores(model);
    return std::ranges::all_of(scores.passes, [&](const ImageScores& s) {
      switch (metric) {
        case FitMetric::psnr: return s.psnr_foreground >= value;
        case FitMetric::ms_ssim: return s.ms_ssim_foreground >= value;
        case FitMetric::flip: return s.flip_foreground <= value;
      }
      return true;
    });
  }

  const FitOptions options_;
  FitLadders ladders_;
  std::vector<double> weights_;  // [#images] as `TextureLadders::set_weight`
  std::uint64_t bytes_ = 0;
  std::optional<Best> best_;
  std::vector<JointPoint> all_;  // of an exhaustive search
  std::vector<JointPoint> way_;
};

BudgetFit::BudgetFit(const Model& model, const FitOptions& options, Context& context) {
  check_options(model, options);
  finder_ = std::make_unique<Finder>(model, options, context);
}

BudgetFit::~BudgetFit() = default;

FitResult BudgetFit::within(std::uint64_t bytes) { return finder_->within(bytes); }
FitResult BudgetFit::like(FitMetric metric, double value) { return finder_->like(metric, value); }
std::vector<FitPoint> BudgetFit::way() { return finder_->way(); }
std::vector<FitPoint> BudgetFit::all() { return finder_->all(); }
Model BudgetFit::at(std::size_t point) { return finder_->at(point); }

OptionList describe(FitOptions& o) {
  OptionList options{
      {"triangles", "Triangles to keep at most.", &o.triangles, "triangles", 1},
      {"view-size", "Pixels along the height of the pictures that decide: how large the model will be seen.",
       &o.view_size, "pixels", 64, 4096},
      {"distortion", "What counts as lost in these pictures.",
       choice(o.distortion, {"mse", "ms-ssim", "flip"}), ""},
      {"search", "How choices are found: from all down, from little up, or by drawing all.",
       choice(o.search, {"prune", "grow", "exhaustive"}), ""},
      {"ladders", "Whether all meshes and all images go down together, or each for itself.",
       choice(o.ladders, {"joint", "separate"}), ""},
      {"fineness",
       "Rungs that ladders have for each usual one: a curve of more points, which takes as many times as "
       "long. What fits into a budget is tried more finely anyway.",
       &o.fineness, "rungs", 1, 8}};
  ImageOutputOptions output;
  for (Option& option : describe(output)) {
    if (option.name != "texture-format") continue;
    option.value = choice(o.format, std::get<Option::Choice>(option.value).names);
    options.push_back(option);
  }
  return options;
}

}  // namespace fovea
