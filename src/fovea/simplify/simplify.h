#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/render/view.h"
#include "fovea/simplify/record.h"
#include "fovea/texture/felzenszwalb.h"

namespace fovea {

/// Where the vertex that an edge collapses to is put.
enum class Placement {
  optimal,    ///< At the minimum of the error; falls back to the edge's ends and middle.
  half_edge,  ///< At one end of the edge: every vertex of the result is a vertex of the input.
};

/// What a collapse costs.
enum class Metric {
  automatic,        ///< Quadrics for the bulk, the image for the last part, if the target is small enough.
  quadric,          ///< Distance to the planes that a vertex stands for, attributes among them (quadric.h).
  visibility,       ///< The same, times how much of a vertex's surface views see (exposure.h).
  entropy,          ///< What views lose of viewpoint entropy, by the regions of textures,
  polygon_entropy,  ///< or by triangles (Castelló et al. 2007).
  image,            ///< What changes in pictures of the original.
};

const char* to_string(Metric metric);

/// What the pictures of `Metric::image` show.
enum class ImagePass {
  base_color,  ///< Base colour alone.
  lit,         ///< Base colour under light, so that shape shows too.
};

/// What to simplify to, and what counts as an error. Targets given together: the first reached stops.
struct SimplifyOptions {
  std::optional<std::int64_t> triangles;  ///< Triangles to keep over all meshes, each counted once.
  std::optional<double> ratio;            ///< Fraction of the triangles to keep, 0..1.
  std::optional<double> error;            ///< Largest error, as a fraction of the scene's diagonal.
  std::optional<double> error_abs;        ///< Largest error in scene units.
  /// Each mesh to the same ratio, instead of one queue that spends triangles where they matter.
  bool per_mesh = false;

  Placement placement = Placement::optimal;
  /// Weights of attributes against position, free of the model's scale. 1 is the balance that keeps
  /// pictures of real models closest; see collapse_state.cpp for what it stands for in lengths.
  double uv_weight = 1.0;
  double normal_weight = 1.0;
  double color_weight = 1.0;
  /// Weight of the planes that hold open boundaries and seams in place.
  double boundary_weight = 1.0;
  double seam_weight = 1.0;
  /// Never move or remove vertices on open boundaries.
  bool lock_boundary = false;
  Metric metric = Metric::automatic;
  /// The metric begins when so many times the triangles are left that are asked for; until then the quadric
  /// error decides. None: 2 for the image, from the first collapse on for the entropies.
  std::optional<double> metric_from;
  /// Where the other metrics look from: around the scene at rest, perspective.
  ViewOptions views{.set = ViewSet::dodecahedron};
  /// Pixels along each side of a view. None: 256, or fewer for the image of so few triangles that they do.
  std::optional<std::int64_t> view_size;
  ImagePass image_pass = ImagePass::lit;
  /// Of the image: what views hardly see counts as much in the quadric error as the rest. So the largest
  /// distance stays less, and pictures are farther off.
  bool even_exposure = false;
  SegmentOptions regions;  ///< Of textures, for `Metric::entropy`.
  /// Drop the triangles that none of `views` sees (hidden_faces.h), before anything collapses.
  bool cull_hidden = false;
  /// Never change the topology: no component vanishes, no hole or handle closes.
  bool keep_topology = false;
};
OptionList describe(SimplifyOptions& options);

/// How much each vertex matters, [#meshes][#V of the mesh] or empty: multiplies the vertex's error. 1
/// is neutral, more keeps, less gives away; infinity locks the vertex where it is.
using Importance = std::vector<VertexField>;
/// Throws Error(format) for values that are NaN or negative.
void check(const Importance& importance);
/// And Error(usage) for fields of another model.
void check(const Importance& importance, const Model& model);

enum class StopReason {
  target,     ///< The triangle count was reached.
  error,      ///< The next step would exceed the error bound.
  stuck,      ///< No legal collapse is left; see `BlockCounts`.
  cancelled,  ///< The caller asked to stop; the result is the level reached.
};
const char* to_string(StopReason reason);

/// Why the edges that are left could not collapse, one reason each.
struct BlockCounts {
  std::uint64_t edges = 0;     ///< Edges left in all.
  std::uint64_t topology = 0;  ///< Would pinch the surface or change its topology (`keep_topology`).
  std::uint64_t flip = 0;      ///< Would fold the surface or the texture over.
  std::uint64_t locked = 0;    ///< An end is locked (importance, `lock_boundary`).
  std::uint64_t last = 0;      ///< Belong to the last triangles of a component.
};

struct SimplifyResult {
  Model model;            ///< The level asked for; all but the meshes' triangles untouched.
  CollapseRecord record;  ///< Steps down to that level, over `model.meshes` in order.
  std::uint64_t triangles_before = 0;
  std::uint64_t triangles_after = 0;
  std::uint64_t triangles_hidden = 0;  ///< Dropped by `cull_hidden`.
  std::uint64_t triangles_target = 0;  ///< What the count targets came to; 0 if only an error bound.
  /// Error of the result: the largest root-mean-square distance, over the pieces of surface that a
  /// vertex stands for, between the original surface and the result, attribute deviations included
  /// by their weights. An estimate of the engine, not a measured Hausdorff distance.
  double error_rel = 0;  ///< As a fraction of the scene's diagonal.
  double error_abs = 0;  ///< In scene units.
  StopReason stop = StopReason::target;
  BlockCounts blocked;              ///< Filled if `stop` is `stuck`.
  Metric metric = Metric::quadric;  ///< What decided, never `automatic`; with several batches, of the last.
  std::uint64_t metric_from = 0;    ///< Of a metric by views: from so many triangles on.
  double seconds = 0;               ///< Wall time.
};

/// Collapses edges of all meshes of `model` until a target is reached, cheapest first over the whole
/// scene; a mesh is weighed by the largest scale at which a node shows it and counts once however
/// often it is shown. (Garland & Heckbert 1997; attributes after Hoppe 1999.) See collapse_engine.h
/// for how.
///
/// Throws Error(usage) for options out of range, no target at all, or an importance field of the
/// wrong size, and what `check` throws. Not reaching a target is a result.
/// Deterministic for any number of threads. Error(cancelled) comes from finding what is seen.
SimplifyResult simplify(const Model& model, const SimplifyOptions& options, const Importance& importance,
                        Context& context);

/// The level of `model` after the first steps of its record: what `simplify` would have returned, had it
/// stopped there. With `SimplifyOptions::per_mesh` steps go mesh by mesh, and only all of them make sense.
/// Throws Error(usage) if the record has fewer. Cost: that of `replay` of meshes, and a copy of the rest.
Model replay(const Model& model, const CollapseRecord& record, std::size_t step_count);

}  // namespace fovea
