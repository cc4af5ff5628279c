#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// What a filter leaves of waves over a surface, by their eigenvalues λ ≥ 0 under −Δ, the squares of their
/// wave numbers: a function of λ in 0 … `greatest`, as the coefficients of the Chebyshev polynomials T_k of
/// 2 λ / greatest − 1, without a tail of 10⁻⁶.
using Response = std::function<std::vector<double>(double greatest)>;

/// The average under a Gaussian of width σ that ends at cutoff · σ: on a plane its Hankel transform,
///   ∫ g(r) J₀(√λ r) r dr / ∫ g(r) r dr over r from 0 to cutoff · σ, g(r) = exp(−r² / 2σ²).
/// By Graf's addition theorem the coefficients of J₀(√λ r) are (−1)^k J_k(z)², z = √greatest · r / 2, twice
/// but for the first.
Response gaussian_response(double sigma, double cutoff);

/// Filters for fields over a surface by the spectrum of its cotangent Laplacian (Pinkall and Polthier 1993),
/// with a third of the triangles' area at each vertex: averages over neighbourhoods without finding any
/// neighbourhood.
///
/// Negative cotangents count as 0, and areas are raised where the spectrum would reach much farther than at a
/// regular vertex, so that slivers do not rule the cost. Nothing crosses a border; vertices without triangles
/// keep what they have.
class SpectralFilter {
 public:
  /// O(#F), parallel. About 60 bytes per vertex.
  SpectralFilter(const Surface& surface, const Adjacency& adjacency, const Context& context);

  /// Each field under each response: F(−Δ) f by the Chebyshev series of F. [#fields][#responses]. Each term
  /// is a product with a sparse matrix, which all responses and four fields share; a Gaussian of radius r
  /// takes about ½ r √(greatest eigenvalue) terms. Parallel; the same bits for any number of threads.
  std::vector<std::vector<VertexField>> run(std::span<const VertexField> fields,
                                            std::span<const Response> responses,
                                            const Context& context) const;

  /// The area that each vertex counts with; 0 for those without.
  const VertexField& areas() const { return areas_; }

 private:
  template <class Number>
  void run_together(std::span<const VertexField> fields, std::span<const std::vector<double>> series,
                    std::span<std::vector<VertexField>> results, const Context& context) const;

  std::vector<std::uint32_t> first_;  // [#V + 1] into the rows
  std::vector<std::uint32_t> column_;
  std::vector<float> rate_;   // of each neighbour: weight over area
  std::vector<float> leave_;  // [#V], the sum of a row
  VertexField areas_;
  double greatest_ = 0;  // bounds the eigenvalues
};

}  // namespace fovea
