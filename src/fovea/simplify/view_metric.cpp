#include "fovea/simplify/view_metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/surface/pose.h"

namespace fovea {

namespace {

/// Of vertices in the views that pictures of the original are taken in together.
constexpr std::size_t kMostScreenBytes = std::size_t{1} << 26;

PixelContent content_of(Metric metric, ImagePass pass) {
  switch (metric) {
    case Metric::entropy: return PixelContent::region;
    case Metric::polygon_entropy: return PixelContent::face;
    default: return pass == ImagePass::lit ? PixelContent::lit : PixelContent::color;
  }
}

}  // namespace

ViewMetric::ViewMetric(const CollapseState& state, const Model& model,
                       std::span<const std::size_t> mesh_index, const ViewedModel& viewed,
                       const MetricStage& stage, const SimplifyOptions& options, Context& context)
    : state_(state),
      context_(context),
      team_(context),
      model_(model),
      mesh_index_(mesh_index),
      placement_(options.placement),
      content_(content_of(stage.metric, options.image_pass)),
      size_(stage.view_size),
      viewed_(viewed),
      tie_(is_image() ? kImageTie : kEntropyTie) {
  if (content_ == PixelContent::region)
    regions_ = std::make_unique<ModelRegions>(model_regions(model, options.regions, context));
  // Else `look` sees the original itself.
  if (is_image() && stage.from < state.mesh.live_faces) take_pictures();
}

/// A few views at a time, as a model may have far more vertices now than when it is looked at.
void ViewMetric::take_pictures() {
  const std::size_t row = std::max<std::size_t>(state_.mesh.vertices.size() * sizeof(ScreenVertex), 1);
  const std::size_t together = std::clamp<std::size_t>(kMostScreenBytes / row, 1, viewed_.views.size());
  for (std::size_t first = 0; first < viewed_.views.size(); first += together) {
    const std::size_t count = std::min(together, viewed_.views.size() - first);
    make_cost(std::span(viewed_.views).subspan(first, count), {});
    for (std::size_t v = 0; v < count; ++v) originals_.push_back(cost_->picture(v));
    cost_.reset();
  }
}

/// Draws the state as it is in some views.
void ViewMetric::make_cost(std::span<const View> views, Pictures originals) {
  shown_ = std::make_unique<ShownSurface>(state_, model_, mesh_index_, viewed_.scene, viewed_.pose,
                                          std::vector<View>(views.begin(), views.end()), size_, context_);
  values_ = std::make_unique<FaceValues>(state_, *shown_, viewed_.scene, content_, size_, regions_.get(),
                                         mesh_index_, context_);
  cost_ = std::make_unique<ViewCost>(state_, *shown_, *values_,
                                     is_image() ? ViewMeasure::image : ViewMeasure::entropy, size_,
                                     std::move(originals), context_, team_);
}

void ViewMetric::look(std::span<const VertexField* const> importance) {
  make_cost(viewed_.views, std::move(originals_));
  const auto count = static_cast<double>(viewed_.views.size());
  scale_ = is_image() ? 1 / (3.0 * 255 * 255 * pixel_count(viewed_.views, size_)) : 1 / count;
  place_.resize(state_.mesh.edges.size());
  part_.resize(state_.mesh.edges.size());
  noted_.assign(state_.mesh.edges.size(), 0);
  changed_.assign(state_.mesh.vertices.size(), 1);
  for (std::size_t s = 0; s < importance.size(); ++s) {
    if (importance[s] == nullptr || importance[s]->empty()) continue;
    if (importance_.empty()) importance_.assign(state_.mesh.vertices.size(), 1.0f);
    for (std::size_t v = 0; v < importance[s]->size(); ++v) {
      const std::size_t at = state_.slots[s].first_vertex + v;
      importance_[at] = importance[s]->values()[state_.mesh_vertex[at].index()];
    }
  }
}

ViewMetric::Memory ViewMetric::make_memory(CollapseState& state) const {
  return {ValueMerge(state, placement_), cost_->make_scratch()};
}

double ViewMetric::price(std::uint32_t e, const Candidate& place, const ValueMerge& merge,
                         ViewCost::Scratch& scratch) const {
  PartialChange part;
  return price_up_to(std::numeric_limits<double>::infinity(), e, place, merge, scratch, part);
}

double ViewMetric::price_up_to(double limit, std::uint32_t e, const Candidate& place, const ValueMerge& merge,
                               ViewCost::Scratch& scratch, PartialChange& part) const {
  const auto [a, b] = state_.mesh.edges[e].ends;
  const double tie = tie_ * place.cost;
  double scale = scale_;
  // Locked ends have an infinite importance, but do not move.
  if (!importance_.empty()) {
    const auto weight = [&](std::uint32_t v) {
      return state_.mesh.vertices[v].locked ? 1.0 : static_cast<double>(importance_[v]);
    };
    scale *= 0.5 * (weight(a) + weight(b));
  }
  const double most = scale > 0 ? (limit - tie) / scale : std::numeric_limits<double>::infinity();
  cost_->add_change(a, b, place.position, merge, most, scratch, part);
  return std::max(cost_->amount(part), 0.0) * scale + tie;
}

double ViewMetric::price_of_loss(std::span<const std::uint32_t> faces, double cost,
                                 ViewCost::Scratch& scratch) const {
  return std::max(cost_->change_without(faces, scratch), 0.0) * scale_ + tie_ * cost;
}

void ViewMetric::note(std::uint32_t e, const Candidate& place, const PartialChange& part) {
  place_[e] = place;
  part_[e] = part;
  noted_[e] = collapses_;
}

bool ViewMetric::is_current(std::uint32_t e) const {
  const auto [a, b] = state_.mesh.edges[e].ends;
  return noted_[e] >= std::max(changed_[a], changed_[b]);
}

void ViewMetric::before_collapse(std::uint32_t a, std::uint32_t b, Vec3d p) {
  faces_.clear();
  for (const std::uint32_t v : {a, b}) {
    for (const std::uint32_t c : state_.mesh.ring(v)) {
      const CornerView at_c = state_.mesh.view(c);
      if (v == a || (at_c.next != a && at_c.previous != a)) faces_.push_back(c / 3);
    }
  }
  cost_->take_out(faces_);
  cost_->move(a, b, p);
}

void ViewMetric::after_collapse(std::uint32_t a, std::uint32_t b) {
  ++collapses_;
  faces_.clear();
  changed_[b] = collapses_;
  for (const std::uint32_t c : state_.mesh.ring(b)) {
    faces_.push_back(c / 3);
    const CornerView at_c = state_.mesh.view(c);
    changed_[at_c.next] = changed_[at_c.previous] = collapses_;
  }
  cost_->put_in(faces_);
  if (!importance_.empty()) importance_[b] = std::max(importance_[a], importance_[b]);
}

}  // namespace fovea
