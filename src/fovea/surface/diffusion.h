#pragma once

#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// Heat flow over a surface: ∂f/∂t = Δf with the cotangent Laplacian (Pinkall and Polthier 1993) and a third
/// of the triangles' area at each vertex. After the time σ² / 2 a field is its average over the geodesic
/// Gaussian of width σ, to first order.
///
/// Negative cotangents count as 0, and areas are raised where heat would leave much faster than from a
/// regular vertex, so that slivers neither break the maximum principle nor rule the cost. No heat crosses a
/// border; vertices without triangles keep theirs.
class HeatFlow {
 public:
  /// O(#F), parallel. About 60 bytes per vertex.
  HeatFlow(const Surface& surface, const Adjacency& adjacency, const Context& context);

  /// Each field after each of `times`, which rise from 0 or more. The exponential of the Laplacian by its
  /// Chebyshev series, to 10⁻⁶ of the field's range: about 5 · √(last time · fastest rate / 2) products with
  /// a sparse matrix, which four fields share. [#fields][#times]. Parallel; the same bits for any number of
  /// threads.
  std::vector<std::vector<VertexField>> run(std::span<const VertexField> fields,
                                            std::span<const double> times, const Context& context) const;

  /// The area that each vertex counts with; 0 for those without.
  const VertexField& areas() const { return areas_; }

 private:
  template <class Number>
  void run_together(std::span<const VertexField> fields, std::span<const double> times,
                    std::span<std::vector<VertexField>> results, const Context& context) const;

  std::vector<std::uint32_t> first_;  // [#V + 1] into the rows
  std::vector<std::uint32_t> column_;
  std::vector<float> rate_;   // of each neighbour: weight over area
  std::vector<float> leave_;  // [#V], the sum of a row
  VertexField areas_;
  double fastest_ = 0;  // bounds the eigenvalues
};

}  // namespace fovea
