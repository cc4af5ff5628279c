#include "fovea/simplify/view_cost.h"
#include "fovea/simplify/local_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "fovea/base/random.h"
#include "fovea/sample/sample.h"
#include "fovea/simplify/collapse_engine.h"
#include "fovea/simplify/view_metric.h"
#include "support/by_quadrics.h"

namespace fovea {
namespace {

/// A model in the engine with its views, whose pictures are not all equally wide.
struct Trial {
  const Model& model;
  SimplifyOptions options;
  std::vector<VertexField> importance;  // [#meshes] or empty
  CollapseState state;
  std::vector<std::size_t> mesh_index;
  Context context;
  ViewedModel viewed;
  std::unique_ptr<ViewMetric> views;

  Trial(const Model& m, const SimplifyOptions& o, std::vector<VertexField> fields = {}, int threads = 1)
      : model(m),
        options(o),
        importance(std::move(fields)),
        viewed(viewed_model(model, options.views, stage(), context)) {
    context.threads = threads;
    constexpr double kAspects[] = {1, 1.75, 0.6};
    for (std::size_t v = 0; v < viewed.views.size(); ++v) viewed.views[v].aspect = kAspects[v % 3];
    std::vector<const TriMesh*> meshes;
    std::vector<const VertexField*> pointers;
    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
      meshes.push_back(&model.meshes[i].surface);
      mesh_index.push_back(i);
      pointers.push_back(importance.empty() ? nullptr : &importance[i]);
    }
    const std::vector<double> scales(meshes.size(), 1.0);
    state = make_collapse_state(meshes, scales, pointers, {}, bounds(model).diagonal(), options, context);
    views = std::make_unique<ViewMetric>(state, model, mesh_index, viewed, stage(), options, context);
    views->look(pointers);
  }
  MetricStage stage() const { return metric_stage(options, 0, 0); }
  CollapseOutcome to(std::uint64_t triangles) {
    CollapseOutcome outcome;
    collapse(state, triangles, std::numeric_limits<double>::infinity(), options, views.get(), context,
             outcome);
    return outcome;
  }
  /// Views of the state as it is now, drawn anew.
  std::unique_ptr<ViewMetric> fresh() {
    auto drawn = std::make_unique<ViewMetric>(state, model, mesh_index, viewed, stage(), options, context);
    drawn->look({});
    return drawn;
  }
};

SimplifyOptions options_for(Metric metric, Placement placement = Placement::optimal) {
  SimplifyOptions options;
  options.metric = metric;
  options.placement = placement;
  options.views.set = ViewSet::octahedron;
  options.view_size = 64;
  options.regions.most_texels = 64 * 64;  // regions of any kind will do
  return options;
}

/// About a thousand triangles.
Model sample(const std::string& name) {
  Context context;
  return make_sample(name, 0.02, context);
}

constexpr Metric kPixelMetrics[] = {Metric::image, Metric::entropy, Metric::polygon_entropy};
constexpr const char* kSamples[] = {"vase", "arm", "spheres", "terrain"};

void expect_same_lists(const ViewCost& ours, const ViewCost& fresh) {
  for (std::size_t v = 0; v < ours.view_count(); ++v) {
    const FragmentLists &x = ours.fragments(v), &y = fresh.fragments(v);
    ASSERT_EQ(x.size(), y.size());
    ASSERT_EQ(x.width(), y.width());
    for (std::size_t p = 0; p < x.pixel_count(); ++p) ASSERT_EQ(x.at(p), y.at(p)) << p;
  }
}

TEST(ViewCost, ListsStayThoseOfAFreshDrawing) {
  for (const char* name : kSamples) {
    const Model model = sample(name);
    for (const Metric metric : kPixelMetrics) {
      if (metric != Metric::image && std::string(name) != "vase") continue;  // the lists are the same
      Trial trial(model, options_for(metric));
      const std::uint64_t start = trial.state.mesh.live_faces;
      for (const std::uint64_t part : {2, 5, 20}) {
        trial.to(start / part);
        // Vertices between joints and morphs bend by a mixture that only the trial knows.
        if (std::string(name) == "arm") continue;
        SCOPED_TRACE(name);
        expect_same_lists(trial.views->cost(), trial.fresh()->cost());
      }
    }
  }
}

/// Where one collapse took place, in the numbers of the engine.
struct Done {
  std::uint32_t e, a, b;
};
std::optional<Done> done(const CollapseState& before, const CollapseStep& step) {
  if (step.kind != StepKind::collapse) return std::nullopt;
  const auto find = [&](VertexId id) {
    const MeshSlot& slot = before.slots[step.mesh];
    for (std::uint32_t v = slot.first_vertex;; ++v)
      if (before.mesh_vertex[v] == id) return v;
  };
  const std::uint32_t a = find(step.removed), b = find(step.kept);
  for (std::uint32_t e = 0; e < before.mesh.edges.size(); ++e) {
    const auto [x, y] = before.mesh.edges[e].ends;
    if ((x == a && y == b) || (x == b && y == a)) return Done{e, x, y};
  }
  return std::nullopt;
}

double difference(const ViewCost& original, const ViewCost& fresh) {
  double sum = 0;
  for (std::size_t v = 0; v < original.view_count(); ++v) {
    auto x = original.picture(v);
    const auto y = fresh.picture(v);
    mark_inside(x, original.fragments(v).width(), original.fragments(v).height());
    for (std::size_t p = 0; p < x.size(); ++p) sum += static_cast<double>(squared_difference(y[p], x[p]));
  }
  return sum;
}

/// |H − H'| added up over views that were drawn anew, by the formula; each as often as it is as large as the
/// largest.
double entropy_change(const ViewCost& before, const ViewCost& after) {
  const auto entropy = [](const std::vector<std::uint32_t>& picture) {
    std::map<std::uint32_t, double> count;
    for (const std::uint32_t value : picture) ++count[value];
    double h = 0;
    for (const auto& [value, n] : count) {
      const double share = n / static_cast<double>(picture.size());
      h -= share * std::log2(share);
    }
    return h;
  };
  double sum = 0, largest = 0;
  for (std::size_t v = 0; v < before.view_count(); ++v) {
    const auto pixels = static_cast<double>(before.picture(v).size());
    sum += pixels * std::abs(entropy(before.picture(v)) - entropy(after.picture(v)));
    largest = std::max(largest, pixels);
  }
  return sum / largest;
}

/// All vertices locked but one, so that every trial collapses another edge.
std::vector<VertexField> all_locked_but_one(const Model& model, std::uint64_t seed) {
  Random random(seed);
  std::vector<VertexField> fields;
  for (const Mesh& mesh : model.meshes) {
    fields.emplace_back(mesh.surface.vertex_count(), std::numeric_limits<float>::infinity());
    fields.back().values()[random.below(static_cast<std::uint32_t>(fields.back().size()))] = 1;
  }
  return fields;
}

TEST(ViewCost, SaysWhatTwoDrawingsDifferBy) {
  for (const Metric metric : kPixelMetrics) {
    double changes = 0;
    int most_pieces = 0;
    for (const char* name : {"vase", "arm"}) {
      // Coarse, so that most collapses show.
      Context context;
      SimplifyOptions coarse = test::by_quadrics();
      coarse.ratio = 0.2;
      const Model model = simplify(sample(name), coarse, {}, context).model;
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const SimplifyOptions options = options_for(metric, Placement::half_edge);
        Trial before(model, options, all_locked_but_one(model, seed)),
            after(model, options, before.importance);
        const std::uint64_t count = after.state.mesh.live_faces;
        const CollapseOutcome outcome = after.to(count - 1);
        if (outcome.record.steps.empty()) continue;  // the vertex cannot go
        const auto at = done(before.state, outcome.record.steps[0]);
        if (!at) continue;
        ViewMetric::Memory planned = before.views->make_memory(before.state);
        const bool keeps_a = before.state.mesh_vertex[at->a] == outcome.record.steps[0].kept;
        const Vec3d p = before.state.mesh.position(keeps_a ? at->a : at->b);
        planned.merge.plan(at->e, at->a, at->b, p);
        const double predicted =
            before.views->cost().change(at->a, at->b, p, planned.merge, *planned.scratch);
        const std::unique_ptr<ViewMetric> fresh = after.fresh();
        if (metric == Metric::image) {
          EXPECT_EQ(predicted, difference(before.views->cost(), fresh->cost())) << name << seed;
          EXPECT_EQ(after.views->cost().total(), predicted) << name << seed;
        } else {
          // Whole numbers here, logarithms of doubles there.
          EXPECT_NEAR(predicted, entropy_change(before.views->cost(), fresh->cost()), 1e-9) << name << seed;
        }
        // Piece by piece it is the same.
        PartialChange part;
        int pieces = 0;
        while (!before.views->cost().is_whole(part)) {
          const double limit = before.views->cost().amount(part);
          before.views->cost().add_change(at->a, at->b, p, planned.merge, limit, *planned.scratch, part);
          ++pieces;
        }
        EXPECT_EQ(before.views->cost().amount(part), predicted) << name << seed;
        most_pieces = std::max(most_pieces, pieces);
        changes += std::abs(predicted);
      }
    }
    EXPECT_GT(changes, 0) << "nothing was tested";
    EXPECT_GT(most_pieces, 1) << "no sum stopped before the last view";
  }
}

TEST(ViewCost, AHoleCountsMoreThanAnOutlineThatMoves) {
  constexpr int kWidth = 5, kHeight = 4;
  constexpr PackedColor kGround = 0x00808080, kGrey = 0xFF808080;
  std::vector<PackedColor> picture(kWidth * kHeight, kGrey);
  for (const std::size_t x : {0, 1, 2, 3, 4}) picture[x] = kGround;  // the first row
  mark_inside(picture, kWidth, kHeight);
  for (std::size_t p = 0; p < picture.size(); ++p) {
    const bool is_inside = p / kWidth == 2 && p % kWidth > 0 && p % kWidth < 4;
    EXPECT_EQ(picture[p] >> 24 == kInside, is_inside) << p;
    EXPECT_EQ(squared_difference(kGrey, picture[p]), p < kWidth ? 8128 : 0) << p;
    EXPECT_EQ(squared_difference(kGround, picture[p]), p < kWidth ? 0 : is_inside ? 64512 : 8128) << p;
  }
}

}  // namespace
}  // namespace fovea
