#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/options.h"
#include "fovea/cluster/cluster_properties.h"
#include "fovea/cluster/clusters.h"
#include "fovea/lod/level_selection.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/surface/scene_surface.h"

namespace fovea {

/// What becomes of steps that need some of a neighbouring cluster that goes less far.
enum class ClusterMatching {
  hold,   ///< They are left out: borders are as fine as the finer of the two.
  raise,  ///< The neighbour goes on until it has what the cluster's last step needs, as published.
};

struct ClusterSelectionOptions {
  /// As published, a coarse cluster makes all around it coarse; held back, clusters differ more.
  ClusterMatching matching = ClusterMatching::hold;
};
OptionList describe(ClusterSelectionOptions& options);

/// Selects by salient clusters (Munaretti 2007, section 6.1): each cluster takes the first steps among its
/// own, and how many that are depends on how large and how important it looks.
///
/// Contractions are dealt out to clusters from the least A_est · I_est up, 0.02 of the whole to each, around
/// and around until there are none left.
///   A_est = facing · area / distance,   I_est = S_total · S_peak · S_mean / S_mesh
/// Departures: facing is 1 while a normal of the cluster can look at the eye, and the cosine of the angle
/// beyond it from there on (as printed it grows with the angle); distances are at least a hundredth of the
/// radius; steps whose needs are not all taken are left out, where the thesis lets triangles overlap; and the
/// number of contractions is sought for which the level has as many triangles as asked for.
class ClusterSelection : public LevelSelection {
 public:
  /// `scene` is that of the original at rest, divided into `clusters`; `levels` must outlive this. Throws
  /// Error(usage) if they are of different models. O(#F).
  ClusterSelection(const SceneSurface& scene, const MultiTessellation& levels, const Clusters& clusters,
                   std::vector<ClusterProperties> properties, const ClusterSelectionOptions& options = {});

  void begin(const LevelCamera& camera, const LevelBudget& budget) override;
  bool advance(std::size_t work) override;
  std::size_t total_work() const override { return kTries * levels_.step_count(); }
  const StepBits& taken() const override { return taken_; }
  /// A_est · I_est of each cluster for the last view.
  std::span<const double> importance() const { return importance_; }

 private:
  static constexpr std::size_t kTries = 12;

  void assign_steps(const SceneSurface& scene, const Clusters& clusters);
  void find_neighbors();
  void weigh(const LevelCamera& camera);
  void begin_try();
  void deal(std::uint64_t contractions);
  void match_neighbors();
  void take(std::size_t begin, std::size_t end);
  void finish_try();

  std::span<const std::uint32_t> clusters_of(std::size_t s) const {
    const std::size_t begin = s > 0 ? clusters_end_[s - 1] : 0;
    return {clusters_.data() + begin, clusters_end_[s] - begin};
  }

  /// What a cluster with all steps up to `step` needs another to have: those before `stop`.
  struct Need {
    std::uint32_t step = 0, stop = 0;
  };
  struct Neighbor {
    std::uint32_t cluster = 0;
    std::vector<Need> needs;  ///< Rising in both.
  };

  const MultiTessellation& levels_;
  std::vector<ClusterProperties> properties_;
  ClusterMatching matching_;
  std::vector<std::uint32_t> clusters_end_, clusters_;  // of each step, those it happens in; its own first
  std::vector<std::vector<std::uint32_t>> steps_;       // [#clusters], its own, rising
  std::vector<std::vector<Neighbor>> neighbors_;        // [#clusters]
  StepBits taken_;

  // Of the view in hand:
  std::vector<double> importance_;      // [#clusters]
  std::vector<std::uint32_t> order_;    // [#clusters], the least important first
  std::vector<std::uint64_t> dealt_;    // [#clusters], contractions
  std::vector<std::uint32_t> stop_;     // [#clusters], no step from here on
  std::vector<std::uint32_t> matched_;  // [#clusters], the same with what neighbours need
  std::uint64_t triangles_ = 0;         // at most
  std::uint64_t best_ = 0,
                best_left_ = 0;  // contractions that left the most triangles of those that are few enough
  std::uint64_t low_ = 0, high_ = 0;    // contractions: too few, enough
  std::uint64_t tried_ = 0, left_ = 0;  // of the try in hand: contractions, triangles
  std::size_t done_ = 0;
};

}  // namespace fovea
