#include "flight.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "fovea/gpu/gpu_contraction.h"
#include "fovea/gpu/level_renderer.h"
#include "fovea/lod/level_cracks.h"
#include "fovea/lod/level_model.h"
#include "fovea/lod/view_dependent_lod.h"
#include "fovea/render/render.h"

namespace fovea::cli {

namespace {

constexpr double kElevation = 15 * std::numbers::pi / 180;
constexpr double kFov = 30;
constexpr double kNearest = 1.3;  // of the sphere's radius, from its centre
constexpr int kWarmUp = 3;        // frames before any is timed

double milliseconds(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Pictures of the original to compare with, drawn when they are first needed.
class Judge {
 public:
  Judge(const Model& original, const RenderScene& scene, const std::vector<LevelCamera>& cameras,
        const FlightOptions& options, Context& context)
      : original_(original),
        scene_(scene),
        cameras_(cameras),
        context_(context),
        references_(cameras.size()) {
    options_.width = options_.height = options.size;
  }

  const ReferencePicture& reference(std::size_t frame) {
    auto& reference = references_[frame];
    if (!reference) reference.emplace(render(scene_, cameras_[frame].view, options_, context_));
    return *reference;
  }

  /// The picture of a level, and how like the original's it is.
  std::pair<Image8, ImageScores> judge(std::size_t frame, const VertexHierarchy& hierarchy,
                                       const LevelIndices& level) {
    const Model model = model_of_level(original_, hierarchy, level);
    const RenderScene scene = make_render_scene(model, rest_pose(model), context_, &scene_);
    Picture picture = render(scene, cameras_[frame].view, options_, context_);
    const ImageScores scores = reference(frame).score(picture);
    return {std::move(picture.color), scores};
  }

 private:
  const Model& original_;
  const RenderScene& scene_;
  const std::vector<LevelCamera>& cameras_;
  Context& context_;
  RenderOptions options_;
  std::vector<std::optional<ReferencePicture>> references_;
};

void need_same(const VertexHierarchy& hierarchy, const LevelIndices& a, const LevelIndices& b) {
  bool same = a.triangles == b.triangles;
  for (std::size_t p = 0; same && p < hierarchy.parts.size(); ++p)
    same = std::ranges::equal(a.of_part(hierarchy, p), b.of_part(hierarchy, p));
  if (!same) throw Error(ErrorKind::internal, "the card has other triangles than the processor", "gpu");
}

/// Flies the way once for each ratio.
class Flight {
 public:
  Flight(const Model& original, const VertexHierarchy& hierarchy, LevelSelection& selection,
         const FlightOptions& options, Session& session)
      : hierarchy_(hierarchy),
        selection_(selection),
        options_(options),
        context_(session.context),
        scene_(make_render_scene(original, rest_pose(original), context_)),
        cameras_(flight_cameras(options, scene_.sphere)),
        judge_(original, scene_, cameras_, options, context_),
        cracks_(hierarchy),
        processor_(hierarchy) {}

  void use_card(const Model& original) {
    const auto size = static_cast<int>(options_.size);
    card_ = std::make_unique<GpuContraction>(hierarchy_);
    renderer_ = std::make_unique<LevelRenderer>(original, hierarchy_, size, size);
  }

  FlightReport run(const std::vector<double>& ratios) {
    FlightReport report;
    for (std::size_t r = 0; r < ratios.size(); ++r) {
      const double share = 1 / static_cast<double>(ratios.size());
      const auto tell = [&](double part) {
        context_.advance_or_throw("fly", (static_cast<double>(r) + part) * share);
      };
      LevelBudget budget;
      budget.triangles = static_cast<std::uint64_t>(
          std::floor(ratios[r] * static_cast<double>(hierarchy_.face_count()) + 1e-9));
      std::vector<FrameReport> frames(cameras_.size());
      for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].ratio = ratios[r];
        frames[i].frame = static_cast<int>(i);
      }
      with_processor(budget, frames, tell);
      if (card_) with_card(budget, frames);
      report.frames.insert(report.frames.end(), frames.begin(), frames.end());
    }
    strip_.insert(strip_.begin(), originals());
    report.strip = std::move(strip_);
    return report;
  }

 private:
  /// Calls `look(i, frame)` along the way, after some frames that are not reported.
  template <class Look>
  void go(std::vector<FrameReport>& frames, Look&& look) {
    FrameReport unreported;
    for (int i = 0; i < kWarmUp; ++i) look(0, unreported);
    for (std::size_t i = 0; i < frames.size(); ++i) look(i, frames[i]);
  }

  void with_processor(const LevelBudget& budget, std::vector<FrameReport>& frames, const auto& tell) {
    ViewDependentLod lod(selection_, processor_, static_cast<int>(options_.spread));
    std::vector<Image8>& pictures = strip_.emplace_back();
    go(frames, [&](std::size_t i, FrameReport& frame) {
      const LevelCamera& camera = cameras_[i];
      bool is_new = false;
      frame.cpu_update_ms = milliseconds([&] { is_new = lod.update(camera, budget); });
      frame.triangles = processor_.level().triangle_count();
      if (renderer_) {
        frame.cpu_draw_ms = draw_milliseconds([&] { renderer_->draw(camera, processor_.level()); });
        frame.full_draw_ms = draw_milliseconds([&] { renderer_->draw(camera); });
      }
      if (is_new) frame.cracks = cracks_.count(selection_.taken());
      tell(static_cast<double>(i) / static_cast<double>(frames.size()));
    });
    if (options_.judge_every > 0) look_at(budget, frames, pictures);
  }

  /// Flies again, and compares some of the frames with the original.
  void look_at(const LevelBudget& budget, std::vector<FrameReport>& frames, std::vector<Image8>& pictures) {
    ViewDependentLod lod(selection_, processor_, static_cast<int>(options_.spread));
    for (std::size_t i = 0; i < frames.size(); ++i) {
      lod.update(cameras_[i], budget);
      if (i % static_cast<std::size_t>(options_.judge_every) != 0) continue;
      auto [picture, scores] = judge_.judge(i, hierarchy_, processor_.level());
      frames[i].scores = scores;
      pictures.push_back(std::move(picture));
      context_.advance_or_throw("judge", static_cast<double>(i) / static_cast<double>(frames.size()));
    }
  }

  /// What the strip shows above all levels.
  std::vector<Image8> originals() {
    std::vector<Image8> pictures;
    for (std::size_t i = 0; options_.judge_every > 0 && i < cameras_.size();
         i += static_cast<std::size_t>(options_.judge_every))
      pictures.push_back(judge_.reference(i).picture().color);
    return pictures;
  }

  void with_card(const LevelBudget& budget, std::vector<FrameReport>& frames) {
    ViewDependentLod lod(selection_, *card_, static_cast<int>(options_.spread));
    go(frames, [&](std::size_t i, FrameReport& frame) {
      bool is_new = false;
      frame.gpu_update_ms = draw_milliseconds([&] { is_new = lod.update(cameras_[i], budget); });
      frame.gpu_draw_ms = draw_milliseconds([&] { renderer_->draw(cameras_[i], *card_); });
      if (!is_new) return;
      processor_.begin(selection_.taken());
      processor_.advance(processor_.total_work());
      need_same(hierarchy_, card_->read_back(), processor_.level());
    });
  }

  double draw_milliseconds(const auto& work) const {
    return milliseconds([&] {
      work();
      renderer_->finish();
    });
  }

  const VertexHierarchy& hierarchy_;
  LevelSelection& selection_;
  const FlightOptions& options_;
  Context& context_;
  RenderScene scene_;
  std::vector<LevelCamera> cameras_;
  Judge judge_;
  CrackFinder cracks_;
  Contraction processor_;
  std::unique_ptr<GpuContraction> card_;
  std::unique_ptr<LevelRenderer> renderer_;
  std::vector<std::vector<Image8>> strip_;  // of each ratio so far
};

}  // namespace

OptionList describe(FlightOptions& o) {
  return {{"path", "How the eye moves: once around the model, or coming close on the way.",
           choice(o.path, {"orbit", "approach"}), ""},
          {"frames", "Pictures along the way.", &o.frames, "", 2, 100000},
          {"view-size", "Pixels along each side of a picture.", &o.size, "pixels", 16, 8192},
          {"spread", "Frames over which the work for a level is spread; the level before stays meanwhile.",
           &o.spread, "frames", 1, 1000},
          {"judge-every", "Every so manieth frame is compared with the original; 0 compares none.",
           &o.judge_every, "", 0, 100000}};
}

std::vector<LevelCamera> flight_cameras(const FlightOptions& options, const Sphere& sphere) {
  const double away = sphere.radius / std::sin(0.5 * kFov * std::numbers::pi / 180);
  const double nearest = options.path == FlightPath::orbit ? away : kNearest * sphere.radius;
  std::vector<LevelCamera> cameras;
  for (std::int64_t i = 0; i < options.frames; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(options.frames - 1);
    const double around = 2 * std::numbers::pi * t, close = std::sin(std::numbers::pi * t);
    const double distance = away + (nearest - away) * close * close;
    const Vec3d direction{std::sin(around) * std::cos(kElevation), std::sin(kElevation),
                          std::cos(around) * std::cos(kElevation)};
    LevelCamera& camera = cameras.emplace_back();
    camera.view = view_from(sphere.center + direction * distance, sphere.center, kFov);
    camera.width = camera.height = static_cast<int>(options.size);
  }
  return cameras;
}

FlightReport fly(const Model& original, const VertexHierarchy& hierarchy, LevelSelection& selection,
                 const std::vector<double>& ratios, const FlightOptions& options, bool use_card,
                 Session& session) {
  Flight flight(original, hierarchy, selection, options, session);
  if (use_card) flight.use_card(original);
  return flight.run(ratios);
}

}  // namespace fovea::cli
