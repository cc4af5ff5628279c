#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fovea/surface/surface.h"

// Private to surface.

namespace fovea {

/// Sums over spheres around vertices, under Gaussians of several widths: what averages over straight
/// distances are made of, and nearly all of their time.
class SphereSums {
 public:
  /// `numbers`, [#numbers][#V], are what is summed; `sigmas` rise. Vertices without triangles count nowhere.
  /// O(#V log #V).
  SphereSums(const Surface& surface, const Adjacency& adjacency, std::span<const std::vector<float>> numbers,
             std::span<const double> sigmas, double cutoff);
  ~SphereSums();
  SphereSums(SphereSums&&) = delete;

  /// Σ_x number(x) exp(−d² / 2σ²) over the vertices x within d ≤ cutoff · σ of `vertex`, [#sigmas][#numbers];
  /// weights to 10⁻⁹. O(vertices in the cells around the largest sphere), four at a time.
  void around(std::uint32_t vertex, std::vector<double>& sums) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace fovea
