#pragma once

#include <cstddef>
#include <span>
#include <vector>

// Shared inside Fovea, not installed.

namespace fovea {

/// A way to store an image: what its file takes and what it loses.
struct LadderStep {
  std::size_t number = 0;  ///< The caller's own.
  double bytes = 0, loss = 0;
};

/// From the most bytes to the fewest; each step saves bytes and costs more loss per byte than the one before.
using SizeLadder = std::vector<LadderStep>;

/// Those of `steps` that make a ladder: the lower hull of loss over bytes. O(n log n).
SizeLadder lower_hull(std::vector<LadderStep> steps);

/// [#ladders] The step of each so that all together take at most `bytes`, or the last of all if they cannot:
/// again and again the step down that costs the least loss for each byte it saves. Ladders without steps get
/// 0. O(n · #ladders) in the number of steps.
std::vector<std::size_t> choose_steps(std::span<const SizeLadder> ladders, double bytes);

/// Spends what is left of `bytes`: again and again, of all `ways` to store one of the images, also those
/// that are on no ladder, the one that saves most loss. `chosen` [#ways] are indices into them.
void fill_room(std::span<const std::vector<LadderStep>> ways, double bytes, std::vector<std::size_t>& chosen);

}  // namespace fovea
