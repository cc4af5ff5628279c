#include "fovea/simplify/simplify.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/render/hidden_faces.h"
#include "fovea/simplify/collapse_engine.h"
#include "fovea/simplify/metric_stage.h"
#include "fovea/simplify/salient.h"
#include "fovea/simplify/view_metric.h"

namespace fovea {

namespace {

void check_request(const Model& model, SimplifyOptions options, const Importance& importance) {
  check(describe(options));
  if (!options.triangles && !options.ratio && !options.error && !options.error_abs) {
    throw Error(ErrorKind::usage, "no target is given", "simplify",
                "give --ratio, --triangles, --error or --error-abs; for example --ratio 0.1");
  }
  check(importance, model);
}

/// The largest scale at which each mesh is shown; 1 if it is not.
std::vector<double> mesh_scales(const Model& model) {
  std::vector<double> scales = largest_scales(model);
  for (double& scale : scales) scale = scale > 0 ? scale : 1.0;
  return scales;
}

/// Diagonal of what is shown; of the meshes themselves if no node shows any.
double scene_diagonal(const Model& model) {
  Box box = bounds(model);
  if (box.empty()) {
    for (const Mesh& mesh : model.meshes) box.add(bounds(mesh.surface));
  }
  return box.diagonal() > 0 ? box.diagonal() : 1.0;
}

/// Meshes that go through the engine together, with all that it needs of each.
struct Batch {
  std::vector<std::size_t> mesh_index;
  std::vector<const TriMesh*> meshes;
  std::vector<double> scales;
  std::vector<const VertexField*> importance;      // null where there is none
  std::vector<const VertexField*> weights;         // of quadrics: importance, and how much is seen
  std::vector<const std::vector<FaceId>*> hidden;  // empty if nothing is
  std::uint64_t triangles = 0;                     // hidden ones among them

  void add(const Model& model, std::size_t m, double scale, const Importance& fields,
           const Importance& quadric_fields, const std::vector<std::vector<FaceId>>& without) {
    mesh_index.push_back(m);
    meshes.push_back(&model.meshes[m].surface);
    scales.push_back(scale);
    importance.push_back(fields.empty() ? nullptr : &fields[m]);
    weights.push_back(quadric_fields.empty() ? nullptr : &quadric_fields[m]);
    if (!without.empty()) hidden.push_back(&without[m]);
    triangles += model.meshes[m].surface.face_count();
  }
};

/// One batch for the scene, or one per mesh.
std::vector<Batch> make_batches(const Model& model, const std::vector<double>& scales,
                                const Importance& importance, const Importance& weights,
                                const std::vector<std::vector<FaceId>>& hidden, bool per_mesh) {
  std::vector<Batch> batches;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (model.meshes[m].surface.face_count() == 0) continue;
    if (batches.empty() || per_mesh) batches.emplace_back();
    batches.back().add(model, m, scales[m], importance, weights, hidden);
  }
  return batches;
}

/// Triangles to keep of `batch` when the whole model has `total`; none if there is no count target.
std::optional<std::uint64_t> triangle_target(const SimplifyOptions& options, std::uint64_t batch,
                                             std::uint64_t total) {
  std::optional<std::uint64_t> target;
  // Together the first reached stops: the larger count.
  const auto raise = [&](double share) {
    const auto count = static_cast<std::uint64_t>(std::floor(share * static_cast<double>(batch) + 1e-9));
    target = std::max(target.value_or(0), count);
  };
  if (options.ratio) raise(*options.ratio);
  if (options.triangles)
    raise(std::min(1.0, static_cast<double>(*options.triangles) / static_cast<double>(total)));
  return target;
}

/// Of the model as a whole.
MetricStage stage_of(const Model& model, const SimplifyOptions& options) {
  const std::uint64_t total = counts(model).triangles;
  return metric_stage(options, triangle_target(options, total, total).value_or(0), total);
}

/// In units of the scene's diagonal; infinity without an error target.
double error_bound(const SimplifyOptions& options, double diagonal) {
  double bound = std::numeric_limits<double>::infinity();
  if (options.error) bound = std::min(bound, *options.error);
  if (options.error_abs) bound = std::min(bound, *options.error_abs / diagonal);
  return bound;
}

/// The hidden faces of each mesh. Throws Error(unsupported) if there is nothing else.
std::vector<std::vector<FaceId>> hidden_of(const Model& model, const ViewOptions& views,
                                           const Context& context) {
  std::vector<std::vector<FaceId>> hidden = hidden_faces(model, views, context);
  std::uint64_t faces = 0, hidden_count = 0;
  for (std::size_t m = 0; m < hidden.size(); ++m) {
    faces += model.meshes[m].surface.face_count();
    hidden_count += hidden[m].size();
  }
  if (faces > 0 && hidden_count == faces) {
    throw Error(ErrorKind::unsupported, "no view sees any triangle of the model", {},
                "leave out --cull-hidden, or look from elsewhere with --views");
  }
  return hidden;
}

/// Records that faces go before anything else does.
void drop_hidden(const Batch& batch, CollapseRecord& record) {
  record.triangles_before = batch.triangles;
  for (std::size_t m = 0; m < batch.hidden.size(); ++m) {
    if (batch.hidden[m]->empty()) continue;
    record.removed_faces.insert(record.removed_faces.end(), batch.hidden[m]->begin(), batch.hidden[m]->end());
    CollapseStep step;
    step.kind = StepKind::vanish;
    step.mesh = static_cast<std::uint32_t>(m);
    step.faces_end = static_cast<std::uint32_t>(record.removed_faces.size());
    record.steps.push_back(step);
  }
}

/// Collapses a batch, by quadrics first and then by what views see, as the stage says.
CollapseOutcome collapse_batch(const Model& model, const Batch& batch, std::uint64_t target,
                               const MetricStage& stage, const ViewedModel& viewed,
                               const SimplifyOptions& options, double diagonal, Context& context) {
  CollapseState state = make_collapse_state(batch.meshes, batch.scales, batch.weights, batch.hidden, diagonal,
                                            options, context);
  const double bound = error_bound(options, diagonal);
  CollapseOutcome outcome;
  drop_hidden(batch, outcome.record);
  if (!stage.is_by_views()) {
    collapse(state, target, bound, options, nullptr, context, outcome);
    return outcome;
  }
  ViewMetric views(state, model, batch.mesh_index, viewed, stage, options, context);
  if (stage.from < batch.triangles) collapse(state, stage.from, bound, options, nullptr, context, outcome);
  if (outcome.stop != StopReason::target) return outcome;
  views.look(batch.importance);
  collapse(state, target, bound, options, &views, context, outcome);
  return outcome;
}

/// A stop that says more than another wins when several meshes were simplified apart.
void combine(SimplifyResult& result, const CollapseOutcome& outcome) {
  const auto rank = [](StopReason r) {
    return r == StopReason::cancelled ? 3 : r == StopReason::stuck ? 2 : r == StopReason::error ? 1 : 0;
  };
  if (rank(outcome.stop) > rank(result.stop)) result.stop = outcome.stop;
  result.error_rel = std::max(result.error_rel, outcome.error);
  result.blocked.edges += outcome.blocked.edges;
  result.blocked.topology += outcome.blocked.topology;
  result.blocked.flip += outcome.blocked.flip;
  result.blocked.locked += outcome.blocked.locked;
  result.blocked.last += outcome.blocked.last;
}

/// Appends the steps of one batch to those of the model; `mesh_index` numbers the batch's meshes.
void append(CollapseRecord& all, CollapseRecord&& batch, const std::vector<std::size_t>& mesh_index) {
  const auto faces = static_cast<std::uint32_t>(all.removed_faces.size());
  const auto joins = static_cast<std::uint32_t>(all.joins.size());
  const auto writes = static_cast<std::uint32_t>(all.writes.size());
  for (CollapseStep& step : batch.steps) {
    step.mesh = static_cast<std::uint32_t>(mesh_index[step.mesh]);
    step.faces_end += faces;
    step.joins_end += joins;
    step.writes_end += writes;
  }
  const auto take = [](auto& to, auto&& from) {
    if (to.empty()) {
      to = std::move(from);
    } else {
      to.insert(to.end(), from.begin(), from.end());
    }
  };
  take(all.steps, std::move(batch.steps));
  take(all.removed_faces, std::move(batch.removed_faces));
  take(all.joins, std::move(batch.joins));
  take(all.writes, std::move(batch.writes));
  take(all.floats, std::move(batch.floats));
}

/// A copy in which surfaces with triangles are empty: for those that take their place. Both at once would
/// take more memory than the engine does.
Model without_surfaces(const Model& model) {
  std::vector<Mesh> meshes;
  for (const Mesh& mesh : model.meshes) {
    const bool is_kept = mesh.surface.face_count() == 0;
    meshes.push_back({mesh.name, is_kept ? mesh.surface : TriMesh(), mesh.morph_weights, mesh.json});
  }
  return {model.scenes,
          model.default_scene,
          model.nodes,
          std::move(meshes),
          model.materials,
          model.textures,
          model.samplers,
          model.images,
          model.skins,
          model.animations,
          model.cameras,
          model.extensions_used,
          model.extensions_required,
          model.json,
          model.carried_accessors,
          model.carried_buffer_views};
}

}  // namespace

void check(const Importance& importance) {
  for (std::size_t m = 0; m < importance.size(); ++m) {
    for (const float w : importance[m].values()) {
      if (!(w >= 0)) {
        throw Error(ErrorKind::format, fmt::format("mesh {} has the importance {}", m, w), {},
                    "values are 0 or more; infinity locks a vertex");
      }
    }
  }
}

void check(const Importance& importance, const Model& model) {
  if (importance.empty()) return;
  if (importance.size() != model.meshes.size()) {
    throw Error(ErrorKind::usage,
                fmt::format("importance has {} fields for {} meshes", importance.size(), model.meshes.size()),
                "importance");
  }
  for (std::size_t m = 0; m < importance.size(); ++m) {
    const VertexField& field = importance[m];
    const std::size_t expected = model.meshes[m].surface.vertex_count();
    if (!field.empty() && field.size() != expected) {
      throw Error(ErrorKind::usage,
                  fmt::format("mesh {} has {} vertices, its importance {}", m, expected, field.size()),
                  "importance");
    }
  }
  check(importance);
}

const char* to_string(StopReason reason) {
  switch (reason) {
    case StopReason::target: return "target";
    case StopReason::error: return "error";
    case StopReason::stuck: return "stuck";
    case StopReason::cancelled: return "cancelled";
  }
  return "target";
}

const char* to_string(Metric metric) {
  switch (metric) {
    case Metric::automatic: return "auto";
    case Metric::quadric: return "quadric";
    case Metric::visibility: return "visibility";
    case Metric::entropy: return "entropy";
    case Metric::polygon_entropy: return "polygon-entropy";
    case Metric::image: return "image";
  }
  return "auto";
}

OptionList describe(SimplifyOptions& o) {
  const double infinity = std::numeric_limits<double>::infinity();
  OptionList list{
      {"ratio", "Fraction of the triangles to keep: 0.1 keeps 10 %.", &o.ratio, "", 0, 1},
      {"triangles", "Triangles to keep, each mesh counted once however often it is shown.", &o.triangles,
       "triangles", 0, infinity},
      {"error", "Largest error, as a fraction of the scene's bounding diagonal.", &o.error, "of the diagonal",
       0, infinity},
      {"error-abs", "Largest error in scene units.", &o.error_abs, "scene units", 0, infinity},
      {"per-mesh",
       "Simplify every mesh to the same ratio instead of spending triangles where they matter in the scene.",
       &o.per_mesh, "", 0, 1},
      {"placement",
       "Where a merged vertex goes: at the least error, or at an end of its edge so that all vertices are "
       "original.",
       choice(o.placement, {"optimal", "half-edge"}), ""},
      {"uv-weight", "How much sliding textures count; higher keeps patterns in place.", &o.uv_weight, "", 0,
       1e6},
      {"normal-weight", "How much turning normals count; higher keeps shading.", &o.normal_weight, "", 0,
       1e6},
      {"color-weight", "How much changing vertex colours count.", &o.color_weight, "", 0, 1e6},
      {"boundary-weight", "How firmly open boundaries are held in place.", &o.boundary_weight, "", 0, 1e6},
      {"seam-weight", "How firmly texture seams and material borders are held in place.", &o.seam_weight, "",
       0, 1e6},
      {"lock-boundary", "Never move or remove vertices on open boundaries.", &o.lock_boundary, ""},
      {"keep-topology",
       "Never close holes or handles and never drop a component; targets may become unreachable.",
       &o.keep_topology, ""},
      {"metric",
       "What a collapse costs: distance and attributes (quadric), the same by how much is seen (visibility); "
       "or what a set of views loses, of the entropy of texture regions or of triangles, or of the picture "
       "itself (image). auto: quadric for the bulk, image for the last part, which measured best for its "
       "time.",
       choice(o.metric, {"auto", "quadric", "visibility", "entropy", "polygon-entropy", "image"}), ""},
      {"metric-from",
       "Collapse by quadrics until so many times the target are left, and by the metric from there on; 2 for "
       "image, from the beginning for the entropies.",
       &o.metric_from, "times the target", 1, infinity},
      {"cull-hidden",
       "First drop all triangles that none of the views sees; around the model many more views look than "
       "--views says.",
       &o.cull_hidden, ""},
      {"view-size",
       "Pixels along the height of the views of a metric; 256, for image less if so few triangles are "
       "asked for that it does.",
       &o.view_size, "pixels", 16, 2048},
      {"image-pass", "What the metric image compares: base colour alone, or under light.",
       choice(o.image_pass, {"base-color", "lit"}), ""},
      {"even-exposure",
       "By the metric image, keep what is hardly seen as near to the original as the rest; pictures are "
       "farther off then.",
       &o.even_exposure, ""},
  };
  for (const OptionList& more : {describe(o.views), describe(o.regions)})
    list.insert(list.end(), more.begin(), more.end());
  return list;
}

SimplifyResult simplify(const Model& model, const SimplifyOptions& options, const Importance& importance,
                        Context& context) {
  const auto start = std::chrono::steady_clock::now();
  check_request(model, options, importance);
  ViewedModel viewed;
  Importance weights = importance;
  if (const MetricStage stage = stage_of(model, options); stage.metric != Metric::quadric) {
    viewed = viewed_model(model, options.views, stage, context);
    if (stage.is_by_exposure() && !(stage.is_by_views() && options.even_exposure))
      weights = product(importance, exposed_importance(model, viewed, options, stage, context));
  }
  const auto hidden =
      options.cull_hidden ? hidden_of(model, options.views, context) : std::vector<std::vector<FaceId>>{};
  const double diagonal = scene_diagonal(model);
  const std::vector<Batch> batches =
      make_batches(model, mesh_scales(model), importance, weights, hidden, options.per_mesh);

  SimplifyResult result;
  for (const Batch& batch : batches) result.triangles_before += batch.triangles;
  for (const auto& faces : hidden) result.triangles_hidden += faces.size();
  result.record.triangles_before = result.triangles_before;
  std::vector<std::vector<TriMesh>> levels;
  for (const Batch& batch : batches) {
    const std::uint64_t target =
        triangle_target(options, batch.triangles, result.triangles_before).value_or(0);
    const MetricStage stage = metric_stage(options, target, batch.triangles);
    result.triangles_target += target;
    result.metric = stage.metric;
    result.metric_from = stage.from;
    CollapseOutcome outcome = collapse_batch(model, batch, target, stage, viewed, options, diagonal, context);
    combine(result, outcome);
    levels.push_back(replay(batch.meshes, outcome.record, outcome.record.steps.size()));
    append(result.record, std::move(outcome.record), batch.mesh_index);
  }
  result.model = without_surfaces(model);  // not before: while the engine runs memory is scarce
  for (std::size_t i = 0; i < batches.size(); ++i) {
    for (std::size_t k = 0; k < levels[i].size(); ++k)
      result.model.meshes[batches[i].mesh_index[k]].surface = std::move(levels[i][k]);
  }
  result.triangles_after = result.record.triangles_after(result.record.steps.size());
  result.error_abs = result.error_rel * diagonal;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

Model replay(const Model& model, const CollapseRecord& record, std::size_t step_count) {
  std::vector<const TriMesh*> sources;
  for (const Mesh& mesh : model.meshes) sources.push_back(&mesh.surface);
  std::vector<TriMesh> surfaces = replay(sources, record, step_count);
  Model level = without_surfaces(model);
  for (std::size_t m = 0; m < surfaces.size(); ++m) {
    // As `simplify` does it: what has no triangles is left as it is.
    if (sources[m]->face_count() > 0) level.meshes[m].surface = std::move(surfaces[m]);
  }
  return level;
}

}  // namespace fovea
