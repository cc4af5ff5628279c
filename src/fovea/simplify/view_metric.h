#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/team.h"
#include "fovea/model/model.h"
#include "fovea/simplify/edge_cost.h"
#include "fovea/simplify/face_values.h"
#include "fovea/simplify/metric_stage.h"
#include "fovea/simplify/shown_surface.h"
#include "fovea/simplify/simplify.h"
#include "fovea/simplify/view_cost.h"

namespace fovea {

/// What collapses cost by what views see, for the collapse engine. Made of the original; `look` comes before
/// everything else.
///
/// A price is what the views lose (view_cost.h) by vertex importance, with a little of the quadric error,
/// which decides where views see nothing and keeps the order sane where pixels are chance. Prices that
/// changes around an edge have outdated are known; so an edge is priced again only when it comes up.
class ViewMetric {
 public:
  /// `stage` has a metric by views. Takes the pictures that results are compared with, of the meshes of
  /// `state` as they are now. Their numbers in the model are `mesh_index`. All must outlive this.
  ViewMetric(const CollapseState& state, const Model& model, std::span<const std::size_t> mesh_index,
             const ViewedModel& viewed, const MetricStage& stage, const SimplifyOptions& options,
             Context& context);

  /// Draws what is left of the meshes; from now on prices can be asked for. `importance` are the fields that
  /// the state was made with.
  void look(std::span<const VertexField* const> importance);

  /// What a thread needs to price.
  struct Memory {
    ValueMerge merge;
    std::shared_ptr<ViewCost::Scratch> scratch;
  };
  Memory make_memory(CollapseState& state) const;

  /// The price of collapsing the edge to a place; its cost is the quadric error. `merge` has planned it.
  double price(std::uint32_t e, const Candidate& place, const ValueMerge& merge,
               ViewCost::Scratch& scratch) const;

  /// The same by no more views than until it is more than `limit`, going on from `part`, see
  /// ViewCost::add_change.
  double price_up_to(double limit, std::uint32_t e, const Candidate& place, const ValueMerge& merge,
                     ViewCost::Scratch& scratch, PartialChange& part) const;

  /// The least that anything with this quadric error can cost.
  double least_price(double cost) const { return tie_ * cost; }
  /// The price of losing faces whose quadric error is `cost`, without importance.
  double price_of_loss(std::span<const std::uint32_t> faces, double cost, ViewCost::Scratch& scratch) const;

  /// Notes the best place of an edge as of now, at its price by `part` of the views.
  void note(std::uint32_t e, const Candidate& place, const PartialChange& part);
  /// What is noted, nothing if something has changed around the edge since.
  PartialChange noted_part(std::uint32_t e) const { return is_current(e) ? part_[e] : PartialChange(); }
  /// Whether its price by all views is noted and nothing has changed around it since.
  bool is_fresh(std::uint32_t e) const { return is_current(e) && cost_->is_whole(part_[e]); }
  bool is_noted(std::uint32_t e) const { return noted_[e] > 0; }
  /// Of a price by all views.
  PartialChange whole() const { return {0, static_cast<std::uint32_t>(cost_->view_count())}; }
  const Candidate& noted(std::uint32_t e) const { return place_[e]; }

  /// To be called around a collapse, see ViewCost.
  void before_collapse(std::uint32_t a, std::uint32_t b, Vec3d p);
  void after_collapse(std::uint32_t a, std::uint32_t b);
  void lose(std::span<const std::uint32_t> faces) { cost_->take_out(faces); }

  const ViewCost& cost() const { return *cost_; }
  /// For prices of several edges at once.
  Team& team() { return team_; }

 private:
  /// How much the quadric error (distance² × area, in diagonals) counts beside what changes in all views, of
  /// pictures and of the entropy of regions. Why: docs/simplification.md.
  static constexpr double kImageTie = 2.5, kEntropyTie = 10;

  using Pictures = std::vector<std::vector<std::uint32_t>>;  // [#views][#pixels]
  bool is_current(std::uint32_t e) const;
  bool is_image() const { return content_ == PixelContent::color || content_ == PixelContent::lit; }
  void take_pictures();
  void make_cost(std::span<const View> views, Pictures originals);

  const CollapseState& state_;
  const Context& context_;
  Team team_;
  const Model& model_;
  const std::span<const std::size_t> mesh_index_;
  const Placement placement_;
  const PixelContent content_;
  const int size_;
  const ViewedModel& viewed_;
  Pictures originals_;  // of the metric `image`, until `look`
  std::unique_ptr<ModelRegions> regions_;
  std::unique_ptr<ShownSurface> shown_;
  std::unique_ptr<FaceValues> values_;
  std::unique_ptr<ViewCost> cost_;
  double scale_ = 1;
  const double tie_;
  std::vector<float> importance_;       // [#V], empty if all are 1
  std::vector<Candidate> place_;        // [#E], as noted
  std::vector<PartialChange> part_;     // [#E], that its price is of
  std::vector<std::uint32_t> noted_;    // [#E], collapses so far, then; 0: never
  std::vector<std::uint32_t> changed_;  // [#V], collapses so far at the last change around it
  std::uint32_t collapses_ = 1;         // and one
  std::vector<std::uint32_t> faces_;    // scratch of the collapse
};

}  // namespace fovea
