#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fovea/base/random.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

/// Models and requests of every kind, for tests and fuzz targets that hold what comes out against what must
/// always hold (support/result_fault.h).
namespace fovea::test {

/// What decides about a model: random numbers, or the bytes of a fuzzer until there are no more (then 0).
class Choices {
 public:
  explicit Choices(std::uint64_t seed) : random_(seed), from_bytes_(false) {}
  explicit Choices(std::span<const std::uint8_t> bytes) : random_(0), bytes_(bytes), from_bytes_(true) {}

  /// In [0, bound); bound is at most 65,536.
  std::uint32_t below(std::uint32_t bound);
  /// In [low, high], one of 256 steps for bytes.
  double between(double low, double high);
  bool one_in(std::uint32_t n) { return below(n) == n - 1; }

 private:
  std::uint8_t next_byte();

  Random random_;
  std::span<const std::uint8_t> bytes_;
  bool from_bytes_;
};

/// A model of at most some hundred triangles, as a reader may give it: closed or open surfaces, tubes,
/// triangles in any disorder, some twice or folded flat; one to three meshes in nodes that scale, mirror or
/// show them many times or never; with any layers, charts, morph targets, skins and parts; tiny or huge.
Model any_model(Choices& choices);

/// Options with a target or several, for such a model; the pictures of metrics are small.
SimplifyOptions any_simplify_options(Choices& choices, Metric metric);

/// Mostly none; else weights of all sizes, some of which lock.
Importance any_importance(Choices& choices, const Model& model);

}  // namespace fovea::test
