#include "fovea/simplify/view_metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/surface/pose.h"

namespace fovea {

namespace {

/// How much the quadric error (distance² × area, in diagonals) counts beside the share of all pixels that
/// change. On three models at 5 % a thirtieth of it loses where parts are small, ten times as much loses
/// against it elsewhere.
constexpr double kTie = 10;
/// Pixels of all views together: some 16 bytes each.
constexpr double kMostPixels = 1 << 27;

PixelContent content_of(const SimplifyOptions& options) {
  switch (options.metric) {
    case Metric::entropy: return PixelContent::region;
    case Metric::polygon_entropy: return PixelContent::face;
    default: return options.image_pass == ImagePass::lit ? PixelContent::lit : PixelContent::color;
  }
}

}  // namespace

ViewMetric::ViewMetric(const CollapseState& state, const Model& model,
                       std::span<const std::size_t> mesh_index,
                       std::span<const VertexField* const> importance, const SimplifyOptions& options,
                       Context& context)
    : state_(state), placement_(options.placement) {
  const Pose pose = rest_pose(model);
  const int size = static_cast<int>(options.view_size);
  scene_ = make_render_scene(model, pose, context);
  const std::vector<View> views = views_of(options.views, model, pose, scene_);
  if (static_cast<double>(views.size()) * size * size > kMostPixels) {
    throw Error(
        ErrorKind::limit,
        fmt::format("{} views of {} × {} pixels are more than a metric looks at", views.size(), size, size),
        "--view-size", "take fewer or smaller views");
  }
  shown_ = std::make_unique<ShownSurface>(state, model, mesh_index, scene_, pose, views, size, context);
  if (options.metric == Metric::entropy)
    regions_ = std::make_unique<ModelRegions>(model_regions(model, options.regions, context));
  values_ = std::make_unique<FaceValues>(state, *shown_, scene_, content_of(options), size, regions_.get(),
                                         mesh_index);
  const bool is_image = options.metric == Metric::image;
  cost_ = std::make_unique<ViewCost>(state, *shown_, *values_,
                                     is_image ? ViewMeasure::image : ViewMeasure::entropy, size, context);
  const auto count = static_cast<double>(views.size());
  scale_ = is_image ? 1 / (3.0 * 255 * 255 * count * size * size) : 1 / count;
  place_.resize(state.mesh.edges.size());
  noted_.assign(state.mesh.edges.size(), 0);
  changed_.assign(state.mesh.vertices.size(), 0);
  for (std::size_t s = 0; s < importance.size(); ++s) {
    if (importance[s] == nullptr || importance[s]->empty()) continue;
    if (importance_.empty()) importance_.assign(state.mesh.vertices.size(), 1.0f);
    for (std::size_t v = 0; v < importance[s]->size(); ++v) {
      const std::size_t at = state.slots[s].first_vertex + v;
      importance_[at] = importance[s]->values()[state.mesh_vertex[at].index()];
    }
  }
}

ViewMetric::Memory ViewMetric::make_memory(CollapseState& state) const {
  return {ValueMerge(state, placement_), cost_->make_scratch()};
}

double ViewMetric::price(std::uint32_t e, const Candidate& place, const ValueMerge& merge,
                         ViewCost::Scratch& scratch) const {
  const auto [a, b] = state_.mesh.edges[e].ends;
  double change = std::max(cost_->change(a, b, place.position, merge, scratch), 0.0) * scale_;
  // Locked ends have an infinite importance, but do not move.
  if (!importance_.empty()) {
    const auto weight = [&](std::uint32_t v) {
      return state_.mesh.vertices[v].locked ? 1.0 : static_cast<double>(importance_[v]);
    };
    change *= 0.5 * (weight(a) + weight(b));
  }
  return change + kTie * place.cost;
}

double ViewMetric::price_of_loss(std::span<const std::uint32_t> faces, double cost,
                                 ViewCost::Scratch& scratch) const {
  return std::max(cost_->change_without(faces, scratch), 0.0) * scale_ + kTie * cost;
}

void ViewMetric::note(std::uint32_t e, const Candidate& place) {
  place_[e] = place;
  noted_[e] = collapses_;
}

bool ViewMetric::is_fresh(std::uint32_t e) const {
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
