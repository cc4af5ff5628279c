#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/simplify/salient.h"
#include "fovea/surface/surface.h"

namespace fovea::test {

using Distance = std::function<double(std::uint32_t a, std::uint32_t b)>;

/// Mean curvature of Taubin (1995) as curvature.h has it, edge by edge: Σ_j ω_ij 2 N·(p_j − p_i) / ‖p_j −
/// p_i‖² over the neighbours j of i, ω_ij in proportion to the area of all triangles on the edge, Σ_j ω_ij =
/// 1, and N the normal of Max (1999). O(#V #F).
VertexField taubin_curvature(const Surface& surface);

/// The Gaussian average at every vertex, over all vertices, by its formula; vertices count by `weights`, or
/// alike without. O(#V²).
VertexField gaussian_average(const VertexField& field, double sigma, double cutoff, const Distance& distance,
                             const VertexField& weights = {});

/// The same over the local filter window of Yang et al. (2016) with sphere and Gaussian of one radius, as
/// neighborhood.h reads it; `fall` is k. O(#V² + #V #F).
VertexField window_average(const VertexField& field, const Surface& surface, double radius, double fall,
                           const VertexField& weights = {});

/// Average by diffusion under a Gaussian of width σ that ends at cutoff · σ: the field in the eigenvectors of
/// the cotangent Laplacian M⁻¹ L (M a third of the triangles' area at each vertex), each times
///   ∫ g(r) J₀(√λ r) r dr / ∫ g(r) r dr over r from 0 to cutoff · σ, g(r) = exp(−r² / 2σ²).
/// For surfaces without negative cotangents. O(#V³).
VertexField spectral_average(const VertexField& field, const Surface& surface, double sigma, double cutoff);

/// Itti's normalisation by its words: scale to [0, 1], find the local maxima, multiply.
VertexField promoted(const VertexField& field, const Surface& surface);

/// Mesh saliency of Lee et al. (2005) from mean curvature, with any distance. O(#V²).
VertexField lee_saliency(const VertexField& curvature, const Surface& surface, double unit, double cutoff,
                         const Distance& distance);

/// The signals of textured saliency at the vertices.
struct TexturedSignals {
  VertexField curvature, intensity, opponency, entropy;
  VertexField texels;  ///< That a vertex stands for.
};

/// Textured saliency of Yang et al. (2016) from its signals, λ1 of texture and γ2 of entropy, scaled to
/// 0 … 1:
///   G = Σ N(|GW(r) − GW(2r)|) of curvature, over r = 2^l c, l = 1 … 4,
///   T = (1 − γ2) (N(Σ I) + N(Σ C)) + γ2 N(Σ E), I, C, E the same contrasts of the other signals,
///   S = λ1 N(T) + (1 − λ1) N(G),
/// with c = √(4 A / 3√3), A the mean area of a triangle. O(#V² + #V #F).
VertexField textured_saliency(const TexturedSignals& signals, const Surface& surface, double texture,
                              double entropy);

/// What a vertex's error is multiplied with, by the papers' words (salient.h), over the mean by area.
std::vector<double> salient_weights(const VertexField& saliency, const Surface& surface,
                                    const SalientOptions& options);

/// S_b + Σ_j (S_j − S_b) at each vertex, S_b the least over the poses (Munaretti 2007, equation 4.1).
VertexField multi_pose_saliency(const std::vector<VertexField>& poses);

}  // namespace fovea::test
