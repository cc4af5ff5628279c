#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/lod/lod_chain.h"
#include "fovea/lod/lod_chain_error.h"
#include "fovea/simplify/record.h"

// Private to lod.

namespace fovea {

/// A level that a chain may have: a number of steps of the record, measured.
struct LodChoice {
  std::size_t steps = 0;
  std::uint64_t triangles = 0;
  LodError error;
  double distance = 0;      ///< At which it comes in.
  std::uint64_t bytes = 0;  ///< Of its file at most; 0 for any.
};

/// The triangles that levels 1, 2, ... are to have, of a model with `total`; empty if the screen says.
std::vector<std::uint64_t> lod_targets(const LodChainOptions& options, std::uint64_t total);

/// The distances at which levels 1, 2, ... come in; empty if counts say.
std::vector<double> lod_distances(const LodChainOptions& options, double radius);

/// Measures levels of a record.
class LodMeasure {
 public:
  /// Refers to all of them.
  LodMeasure(const Model& model, const CollapseRecord& record, LodReference& reference, Context& context)
      : model_(model), record_(record), reference_(reference), context_(context) {}

  /// The level of at most so many triangles.
  LodChoice at(std::uint64_t triangles);
  /// The simplest level with an error of at most `length`, to 2 % of its triangles: errors do not quite rise
  /// with every step, so a simpler one may exist.
  LodChoice simplest(double length);

 private:
  /// What is known of a level: an error that it does not stay below, ...
  struct Measured {
    LodChoice choice;
    bool whole = false;         ///< which is its own,
    std::size_t key_poses = 0;  ///< or that in so many key poses.
  };
  LodChoice level(std::uint64_t triangles) const;
  LodChoice in_key_poses(std::uint64_t triangles, double length);
  LodChoice simplest_in_key_poses(double length);
  bool tells(const Measured& known, double length) const;

  const Model& model_;
  const CollapseRecord& record_;
  LodReference& reference_;
  Context& context_;
  std::vector<Measured> measured_;
};

/// Those that a chain keeps of `choices`, finest first, as `make_lod_chain` says; `total` is the original's
/// triangles. A level that takes the place of one before it comes in where that would have.
std::vector<LodChoice> rising(const std::vector<LodChoice>& choices, std::uint64_t total, Context& context);

}  // namespace fovea
