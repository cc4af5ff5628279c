// What saliency costs, and what it does for simplification, as Markdown.
// saliency_bench [--quick] [MODEL-NAME...]   times
// saliency_bench --quality [--default-metric] [MODEL-NAME...]   quadrics, or what looks at pictures, with and
//     without it; some minutes
// saliency_bench --distances [MODEL-NAME...]   mesh saliency by other distances against exact geodesics;
// minutes
// saliency_bench --geodesics [MODEL-NAME...]   exact geodesics against CGAL's; minutes

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/judge/compare.h"
#include "fovea/saliency/agreement.h"
#include "fovea/saliency/mesh_saliency.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/simplify/auto_saliency.h"
#include "fovea/surface/curvature.h"
#include "fovea/surface/geodesic.h"
#include "fovea/surface/local_order.h"
#include "fovea/surface/scene_surface.h"
#include "measure.h"
#include "peers.h"
#include "subjects.h"

namespace fovea::bench {
namespace {

constexpr int kThreads = 2;
/// Exact geodesics over every vertex of more are not waited for.
constexpr std::size_t kMostExact = 200'000;
constexpr SaliencyPreset kPresets[] = {SaliencyPreset::fovea, SaliencyPreset::yang, SaliencyPreset::lee,
                                       SaliencyPreset::munaretti};

SaliencyOptions preset(SaliencyPreset which) {
  SaliencyOptions options;
  options.preset = which;
  return options;
}

/// Shape alone by diffusion: what the papers' times are for.
SaliencyOptions shape_by_diffusion() {
  SaliencyOptions options = preset(SaliencyPreset::munaretti);
  options.distance = DistanceKind::diffusion;
  return options;
}

Cost measure_saliency(const Subject& subject, const SaliencyOptions& options, int repeats) {
  return measure(
      [&]() -> Work {
        auto model = std::make_shared<const Model>(subject.make());
        return [model, options]() -> std::uint64_t {
          Context context;
          context.threads = kThreads;
          return model_saliency(*model, options, context).maps.size();
        };
      },
      repeats);
}

// --- Time -----------------------------------------------------------------------------------------------

std::string time_text(const Cost& cost) {
  return cost.wall_seconds > 0 ? fmt::format("{:.2f}", cost.wall_seconds) : "–";
}

void print_time(const Subject& subject, int repeats) {
  const Model model = subject.make();
  std::size_t vertices = 0;
  for (const Mesh& mesh : model.meshes) vertices += mesh.surface.vertex_count();
  const std::size_t triangles = triangle_count(model);
  const Cost heat = measure_saliency(subject, shape_by_diffusion(), repeats);
  std::vector<Cost> costs;
  for (const SaliencyPreset which : kPresets) {
    const bool exact = which == SaliencyPreset::munaretti;
    costs.push_back(exact && triangles > kMostExact ? Cost{}
                                                    : measure_saliency(subject, preset(which), repeats));
  }
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {:.0f} |\n", subject.name, triangles, time_text(heat),
             time_text(costs[0]), time_text(costs[1]), time_text(costs[2]), time_text(costs[3]),
             static_cast<double>(costs[0].peak_bytes) / static_cast<double>(vertices));
  std::fflush(stdout);
}

/// Mean time of exact distances from one vertex within a part of the diagonal, one thread.
void print_geodesics(const Subject& subject) {
  fmt::print("| {} |", subject.name);
  for (const double part : {0.01, 0.02, 0.05, 0.1}) {
    constexpr std::uint32_t kSources = 200;
    const Cost cost = measure(
        [&]() -> Work {
          Context context;
          const Model model = subject.make();
          const Surface scene = scene_surface(model, rest_pose(model)).surface;
          auto surface = std::make_shared<Surface>(reordered(scene, local_order(scene)));
          auto adjacency = std::make_shared<Adjacency>(*surface, context);
          auto prepared = std::make_shared<GeodesicSurface>(*surface, *adjacency, context);
          auto search = std::make_shared<GeodesicSearch>(*prepared);
          const double radius = part * diagonal(*surface);
          return [surface, adjacency, prepared, search, radius]() -> std::uint64_t {
            std::uint64_t sum = 0;
            for (std::uint32_t i = 0; i < kSources; ++i) {
              const auto v =
                  static_cast<std::uint32_t>(std::uint64_t{i} * surface->positions.size() / kSources);
              sum += search->from(v, radius).size();
            }
            return sum;
          };
        },
        1);
    fmt::print(" {:.3f} ms ({}) |", 1000 * cost.wall_seconds / kSources, cost.result / kSources);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

// --- Distances ------------------------------------------------------------------------------------------

/// Rank correlation by area of mesh saliency over two kinds of distances.
double same_ranks(const Surface& surface, const VertexField& tested, const VertexField& exact,
                  const Context& context) {
  const VertexField areas = vertex_areas(surface, Adjacency(surface, context), context);
  return agreement(tested.values(), exact.values(), areas.values()).spearman;
}

void print_distances(const Subject& subject) {
  Context context;
  context.threads = kThreads;
  const Model model = subject.make();
  const Surface surface = scene_surface(model, rest_pose(model)).surface;
  fmt::print("| {} | {} |", subject.name, triangle_count(model));
  for (const double cutoff : {1.0, 2.0}) {
    const auto of = [&](DistanceKind kind) {
      return mesh_saliency(surface, {{kind, cutoff, VertexWeight::one}, kMunarettiSaliency.unit_rel}, context)
          .saliency;
    };
    const VertexField exact = of(DistanceKind::geodesic);
    fmt::print(" {:.3f} | {:.3f} |", same_ranks(surface, of(DistanceKind::diffusion), exact, context),
               same_ranks(surface, of(DistanceKind::euclidean), exact, context));
    std::fflush(stdout);
  }
  fmt::print("\n");
}

void print_all_distances(const std::vector<Subject>& subjects) {
  fmt::print(
      "Rank correlation (Spearman, by area) of mesh saliency over other distances with that over exact "
      "geodesics, neighbourhoods cut off at one and at two widths.\n\n"
      "| model | triangles | at 1 σ: diffusion | straight | at 2 σ: diffusion | straight |\n"
      "|---|--:|--:|--:|--:|--:|\n");
  for (const Subject& subject : subjects) {
    if (triangle_count(subject.make()) <= kMostExact) print_distances(subject);
  }
}

#ifdef FOVEA_BENCH_CGAL
void print_same_geodesics(const Subject& subject) {
  constexpr std::uint32_t kSources = 2;
  const Context context;
  const Model model = subject.make();
  const Surface surface = scene_surface(model, rest_pose(model)).surface;
  const Adjacency adjacency(surface, context);
  const GeodesicSurface prepared(surface, adjacency, context);
  GeodesicSearch search(prepared);
  const double d = diagonal(surface);
  std::size_t reached = 0;
  double most = 0;
  for (std::uint32_t i = 0; i < kSources; ++i) {
    const auto source =
        static_cast<std::uint32_t>((2 * std::uint64_t{i} + 1) * surface.positions.size() / (2 * kSources));
    const auto found = search.from(source, 0.1 * d);
    std::vector<std::uint32_t> targets;
    for (const auto& r : found) targets.push_back(r.vertex);
    const std::vector<double> expected = cgal_geodesics(surface, source, targets);
    for (std::size_t k = 0; k < expected.size(); ++k)
      most = std::max(most, std::abs(found[k].distance - expected[k]) / d);
    reached += expected.size();
  }
  fmt::print("| {} | {} | {} | {:.1e} |\n", subject.name, triangle_count(model), reached, most);
  std::fflush(stdout);
}

void print_all_same_geodesics(const std::vector<Subject>& subjects) {
  fmt::print(
      "Exact geodesics within a tenth of the diagonal from two vertices against CGAL's: distances compared, "
      "and "
      "their largest difference over the diagonal.\n\n"
      "| model | triangles | distances | largest difference |\n|---|--:|--:|--:|\n");
  for (const Subject& subject : subjects) {
    if (triangle_count(subject.make()) <= kMostExact) print_same_geodesics(subject);
  }
}
#else
void print_all_same_geodesics(const std::vector<Subject>&) {
  throw Error(ErrorKind::unsupported, "built without CGAL");
}
#endif

// --- Pictures -------------------------------------------------------------------------------------------

/// A way to simplify.
struct Variant {
  std::string name;
  std::function<Importance(const Model&, const SimplifyOptions&, Context&)> importance;
};

Variant weighted(const std::string& name, const SaliencyOptions& saliency, const SalientOptions& salient) {
  return {name, [=](const Model& model, const SimplifyOptions&, Context& context) {
            return salient_importance(model, model_saliency(model, saliency, context).saliency, salient,
                                      context);
          }};
}

Variant chosen_by(const std::string& name, Metric metric) {
  return {name, [=](const Model& model, SimplifyOptions options, Context& context) {
            options.metric = metric;
            return choose_saliency(model, options, {}, {}, context).importance;
          }};
}

/// What choosing alone gains, without any saliency: the best of nothing and eight fields of pure chance,
/// chosen as `choose_saliency` chooses.
Importance best_of_chance(const Model& model, const SimplifyOptions& options, Context& context) {
  std::vector<Importance> fields(1);
  std::vector<Model> results;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    std::vector<VertexField> chance;
    for (const Mesh& mesh : model.meshes) {
      VertexField& field = chance.emplace_back(mesh.surface.positions.size());
      for (float& x : field.values()) x = static_cast<float>(random.uniform());
    }
    fields.push_back(salient_importance(model, chance, {}, context));
  }
  for (const Importance& field : fields) results.push_back(simplify(model, options, field, context).model);
  const std::vector<double> flips = small_picture_flips(model, results, context);
  const auto best = std::min_element(flips.begin(), flips.end());
  return fields[static_cast<std::size_t>(best - flips.begin())];
}

/// By views only the gentle ways are tried: by quadrics the others lose everywhere.
std::vector<Variant> variants(Metric metric) {
  std::vector<Variant> all{{"none", [](auto&&...) { return Importance(); }}};
  const std::pair<const char*, SaliencyPreset> presets[] = {
      {"fovea", SaliencyPreset::fovea}, {"yang", SaliencyPreset::yang}, {"lee", SaliencyPreset::lee}};
  const std::pair<const char*, SalientOptions> weightings[] = {
      {"yang", {SaliencyWeighting::yang, 1}},
      {"yang, strength 2", {SaliencyWeighting::yang, 2}},
      {"lee, strength 0.2", {SaliencyWeighting::lee, 0.2}},
      {"lee", {SaliencyWeighting::lee, 1}},
      {"munaretti", {SaliencyWeighting::munaretti, 1}}};
  for (const auto& [name, which] : presets) {
    for (const auto& [weighting, salient] : weightings) {
      if (metric == Metric::quadric || salient.weighting == SaliencyWeighting::yang)
        all.push_back(weighted(fmt::format("{} | {}", name, weighting), preset(which), salient));
    }
  }
  all.push_back(chosen_by("auto | yang", metric));
  if (metric != Metric::quadric) all.push_back(chosen_by("auto, by quadrics | yang", Metric::quadric));
  all.push_back({"chance, the best of nine | yang", best_of_chance});
  return all;
}

/// FLIP of each variant over that of the first, base colour and lit.
std::vector<std::array<double, 2>> relative_flips(const Model& model, const std::vector<Variant>& tried,
                                                  Metric metric, double ratio) {
  Context context;
  context.threads = kThreads;
  SimplifyOptions options;
  options.metric = metric;
  options.ratio = ratio;
  std::vector<Model> models;
  for (const Variant& variant : tried) {
    const Importance importance = variant.importance(model, options, context);
    models.push_back(simplify(model, options, importance, context).model);
  }
  std::vector<const Model*> tests;
  for (const Model& m : models) tests.push_back(&m);
  CompareOptions compare_options;
  compare_options.size = 256;
  compare_options.distance_samples = 1;
  const std::vector<Comparison> found = compare(model, tests, compare_options, context);
  std::vector<std::array<double, 2>> flips;
  for (const Comparison& c : found) {
    std::array<double, 2>& both = flips.emplace_back();
    for (std::size_t p = 0; p < 2; ++p) both[p] = c.passes[p].flip / found[0].passes[p].flip;
  }
  return flips;
}

void print_quality(const std::vector<Subject>& subjects, Metric metric) {
  const std::vector<Variant> tried = variants(metric);
  fmt::print(
      "FLIP over that without saliency at equal triangles, 24 views of 256², geometric mean over {} models "
      "(below "
      "1 is better), and in how many of the pictures of a model it is better.\n\n"
      "| saliency | weighting | 10 %: base colour | lit | better | 3 %: base colour | lit | better |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|\n",
      subjects.size());
  constexpr double kRatios[] = {0.1, 0.03};
  std::vector<std::string> rows(tried.size());
  for (const double ratio : kRatios) {
    std::vector<std::array<double, 2>> logs(tried.size());
    std::vector<int> better(tried.size(), 0);
    for (const Subject& subject : subjects) {
      const auto flips = relative_flips(subject.make(), tried, metric, ratio);
      for (std::size_t i = 0; i < tried.size(); ++i) {
        for (std::size_t p = 0; p < 2; ++p) {
          logs[i][p] += std::log(flips[i][p]) / static_cast<double>(subjects.size());
          better[i] += flips[i][p] < 1;
        }
      }
      fmt::print(stderr, "saliency_bench: {} at {}\n", subject.name, ratio);
    }
    for (std::size_t i = 0; i < tried.size(); ++i)
      rows[i] += fmt::format(" {:.3f} | {:.3f} | {} of {} |", std::exp(logs[i][0]), std::exp(logs[i][1]),
                             better[i], 2 * subjects.size());
  }
  for (std::size_t i = 1; i < tried.size(); ++i) fmt::print("| {} |{}\n", tried[i].name, rows[i]);
}

// --- What is asked for ----------------------------------------------------------------------------------

struct Task {
  int repeats = 3;
  bool quality = false;
  Metric metric = Metric::quadric;
  bool distances = false;
  bool geodesics = false;
  std::vector<std::string> only;
};

std::vector<Subject> chosen(std::vector<Subject> subjects, const Task& task) {
  if (!task.only.empty()) {
    std::erase_if(subjects, [&](const Subject& subject) {
      return std::find(task.only.begin(), task.only.end(), subject.name) == task.only.end();
    });
  }
  return subjects;
}

void print_times(const Task& task) {
  fmt::print(
      "Seconds of saliency, {} threads, model loaded; best of {}. Bytes per vertex: peak of the default, the "
      "decoded textures among them.\n\n"
      "| model | triangles | shape by diffusion | fovea | yang | lee | munaretti (exact geodesics) | bytes "
      "per "
      "vertex |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|\n",
      kThreads, task.repeats);
  const std::vector<Subject> subjects = chosen(saliency_subjects(), task);
  for (const Subject& subject : subjects) print_time(subject, task.repeats);
  fmt::print(
      "\nExact geodesics from one vertex within a part of the diagonal (vertices reached), one thread, mean "
      "of "
      "200 vertices.\n\n"
      "| model | 1 % | 2 % | 5 % | 10 % |\n|---|--:|--:|--:|--:|\n");
  for (const Subject& subject : subjects) print_geodesics(subject);
}

int run(int count, char** words) {
  try {
    Task task;
    for (int i = 1; i < count; ++i) {
      if (std::strcmp(words[i], "--quick") == 0) {
        task.repeats = 1;
      } else if (std::strcmp(words[i], "--quality") == 0) {
        task.quality = true;
      } else if (std::strcmp(words[i], "--default-metric") == 0) {
        task.metric = Metric::automatic;
      } else if (std::strcmp(words[i], "--distances") == 0) {
        task.distances = true;
      } else if (std::strcmp(words[i], "--geodesics") == 0) {
        task.geodesics = true;
      } else {
        task.only.emplace_back(words[i]);
      }
    }
    if (task.metric != Metric::quadric && !task.quality)
      throw Error(ErrorKind::usage, "--default-metric needs --quality");
    if (task.quality) {
      print_quality(chosen(textured_subjects(), task), task.metric);
    } else if (task.distances) {
      print_all_distances(chosen(scan_subjects(), task));
    } else if (task.geodesics) {
      print_all_same_geodesics(chosen(scan_subjects(), task));
    } else {
      print_times(task);
    }
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "saliency_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** words) { return fovea::bench::run(count, words); }
