#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/saliency/viewing.h"
#include "fovea/surface/neighborhood.h"
#include "fovea/surface/pose.h"

namespace fovea {

/// Ways to tell where people look.
enum class SaliencyPreset {
  fovea,      ///< Ours: shape and texture by diffusion, and how the model stands before people.
  yang,       ///< Yang et al. 2016: curvature and texture over local filter windows.
  lee,        ///< Lee, Varshney, Jacobs 2005: curvature over straight distances.
  munaretti,  ///< Munaretti 2007: curvature over geodesic distances.
};

/// What saliency is made of. Whatever is not set is as the preset has it.
struct SaliencyOptions {
  SaliencyPreset preset = SaliencyPreset::fovea;
  std::optional<DistanceKind> distance;  ///< Of neighbourhoods.

  // What each map counts for in the whole, ≥ 0; only their ratios matter.
  std::optional<double> geometry;    ///< Contrast of mean curvature (λ2 of Yang et al.),
  std::optional<double> texture;     ///< of intensity, opponency and entropy of the base colour (λ1),
  std::optional<double> emission;    ///< of emitted light,
  std::optional<double> roughness;   ///< of roughness and metalness,
  std::optional<double> normal_map;  ///< of how far normal maps bend normals.
  std::optional<double> height;      ///< Height along the upright axis,
  std::optional<double> extremity;   ///< distance from the centre (baseline.h for both),
  std::optional<double> visibility;  ///< being seen by people who stand around (viewing.h).
  /// Within the texture's map what entropy counts for, intensity and opponency the rest: 0 … 1 (γ2).
  std::optional<double> entropy_share;

  std::int64_t entropy_window = 9;  ///< n of n × n texels; odd, 3 … 63.
  std::int64_t entropy_bins = 32;   ///< Greys told apart: 2 … 256.
  ViewRing ring;                    ///< Of `visibility`; its `up` also of `height`.
  PoseOptions pose;                 ///< The pose, where `key_poses` is 1.
  /// Most poses to look at; with more than one they come from the model's animations and morph targets
  /// (key_poses.h), and shape counts as by multi_pose.h. Where files give poses, these are looked at instead.
  std::int64_t key_poses = 1;
};
OptionList describe(SaliencyOptions& options);

/// A map over a model: [#meshes][#V of the mesh].
struct SaliencyMap {
  std::string name;
  std::vector<VertexField> fields;
};

struct ModelSaliency {
  std::vector<VertexField> saliency;  ///< [#meshes][#V], 0 … 1; 0 in meshes that nothing shows.
  /// All that it was made of, in the order of the work: "curvature", "curvature-contrast-1" …, "geometry",
  /// "intensity", ..., "texture", "height", ... Only what counts.
  std::vector<SaliencyMap> maps;
  std::vector<std::string> poses;  ///< Names of those that were looked at.
  bool textured = false;           ///< Whether the base colour differs anywhere.
};

/// Where people look on a model, over all its meshes as the scene places them (scene_surface.h).
///
/// Signals (curvature, those of the textures) are compared with their surroundings at several scales, peaks
/// promoted (contrast.h), and maps added up by weight:
/// - `lee`, `munaretti`: curvature at five scales of the scene's diagonal (mesh_saliency.h);
/// - `yang`: G, T and λ1 N(T) + λ2 N(G) of the paper at four pairs of radii 2^l √(4A / 3√3), A the mean area
///   of a triangle, λ and γ one half each;
/// - `fovea`: the scales of `lee`; maps are scaled between their 2nd and 98th percentile by area rather than
/// by
///   their peaks, then added.
/// A model without texture is judged by the rest. The sum is scaled to 0 … 1. If it is the same everywhere,
/// as on a plane or where neighbourhoods hold no second vertex, saliency is 0, which is reported to `context`
/// as "even-saliency".
///
/// `poses` are models of the same connectivity in other poses. Throws Error(usage) for options out of
/// range or if all weights are 0; Error(unsupported) if poses do not fit or triangles lie beyond what floats
/// hold. Always a number, and the same in any unit of length. Parallel; the same bits for any number of
/// threads. Cost: surface_signals.h, `gaussian_averages` per pose, viewing.h.
ModelSaliency model_saliency(const Model& model, const SaliencyOptions& options, Context& context,
                             std::span<const Model> poses = {});

}  // namespace fovea
