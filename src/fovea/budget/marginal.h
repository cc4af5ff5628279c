#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace fovea {

/// A rung on each of several ladders: 0 is the best and largest.
using Rungs = std::vector<std::size_t>;

/// Things that each come in several sizes and are paid from one budget: the mesh and the textures of a model.
struct JointLadders {
  std::vector<std::size_t> rungs;                    ///< [#ladders] How many each has, 1 or more.
  std::function<std::uint64_t(const Rungs&)> bytes;  ///< Falls along every ladder.
  std::function<double(const Rungs&)> loss;          ///< What is lost by them together, 0 or more. Costly.
};

/// What some rungs take and lose.
struct JointPoint {
  Rungs rungs;
  std::uint64_t bytes = 0;
  double loss = 0;
};

/// Marginal analysis by pruning (Horbelt, Balmelli and Vetterli 2001): from the best of all ladders, again
/// and again the step down that loses least for each byte it saves, until no more than `bytes` are taken or
/// all ladders end. Every point on the way, the first included: the choice for any number of bytes above the
/// last.
///
/// What a step loses is measured when it comes up and kept until its own ladder moves on, as losses of meshes
/// and of textures nearly add up; before a step is taken, one that was measured elsewhere is measured again,
/// as far as it went. Losses are asked for about once or twice for each step taken.
///
/// A step goes down one rung, or up to `ahead` [#ladders] of them if that loses less for each byte: where
/// losses rise by fits and starts, a rung that is bad for its bytes hides a good one below it, and one at a
/// time never gets there. What a step passes over is not on the way. One where nothing or 0 is given.
std::vector<JointPoint> prune(const JointLadders& ladders, std::uint64_t bytes,
                              std::span<const std::size_t> ahead = {});

/// The other way: from the smallest of all up, the step that gains most for each byte, while they are within
/// `bytes`. Every point on the way. Empty if the smallest takes more.
std::vector<JointPoint> grow(const JointLadders& ladders, std::uint64_t bytes);

/// All points, of which the best are those on the lower hull of loss over bytes.
std::vector<JointPoint> exhaust(const JointLadders& ladders);

/// Of points those that lose least for what they take, from the largest down: no other takes less and loses
/// no more, and loss per byte saved rises from step to step.
std::vector<JointPoint> lower_hull(std::vector<JointPoint> points);

}  // namespace fovea
