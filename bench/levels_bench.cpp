// What a record of levels costs and holds, as Markdown.
// levels_bench [--queries N] [MODEL-NAME...]   building it, files, queries, errors against the original,
//     and N random queries whose levels are looked at; minutes

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/io/write.h"
#include "fovea/judge/surface_distance.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/levels_file.h"
#include "fovea/lod/live_level.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/simplify/simplify.h"
#include "fovea/surface/closest_point.h"
#include "fovea/surface/pose.h"
#include "fovea/surface/scene_surface.h"
#include "level_check.h"
#include "subjects.h"
#include "words.h"

namespace fovea::bench {
namespace {

constexpr int kThreads = 2;
constexpr double kCoarsest = 0.005;
constexpr std::int64_t kSamples = 500'000;

double seconds(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A model with all of its levels.
struct Leveled : LeveledModel {
  double simplify_seconds = 0, build_seconds = 0;
};

Leveled make_leveled(const Subject& subject, Context& context) {
  Leveled result;
  result.original = subject.make();
  SimplifyOptions options;
  options.metric = Metric::quadric;
  options.ratio = kCoarsest;
  options.placement = Placement::half_edge;
  CollapseRecord record;
  result.simplify_seconds = seconds([&] { record = simplify(result.original, options, {}, context).record; });
  result.build_seconds =
      seconds([&] { result.levels = make_multi_tessellation(result.original, std::move(record), context); });
  return result;
}

/// Steps of the longest chain in which each needs the one before.
std::uint32_t longest_chain(const MultiTessellation& levels) {
  std::vector<std::uint32_t> chain(levels.step_count(), 1);
  for (std::size_t s = 0; s < chain.size(); ++s) {
    for (const std::uint32_t needed : levels.needs_of(s)) chain[s] = std::max(chain[s], chain[needed] + 1);
  }
  return chain.empty() ? 0 : std::ranges::max(chain);
}

void print_costs(const std::string& name, const Leveled& model) {
  const MultiTessellation& levels = model.levels;
  const auto triangles = static_cast<double>(levels.triangles);
  const double diagonal = bounds(model.original).diagonal();
  std::vector<float> allowed(levels.first_vertex.back(), static_cast<float>(1e-3 * diagonal));
  Cut cut;
  const double query = seconds([&] { cut = cut_within(levels, allowed); });
  const double read = seconds([&] { level_of(model.original, levels, cut); });
  fmt::print("| {} | {} | {} | {} | {:.2f} | {:.2f} | {:.0f} | {:.1f} | {:.0f} | {} |\n", name,
             levels.triangles, levels.step_count(), longest_chain(levels), model.simplify_seconds,
             model.build_seconds, static_cast<double>(levels.bytes()) / triangles, 1e3 * query, 1e3 * read,
             triangles_of(levels, cut));
}

/// A file of all levels: its size, and how long it takes to make and to read.
void print_file(const std::string& name, const Leveled& model, Context& context) {
  const ModelCounts whole = counts(model.original);
  const auto images = static_cast<double>(whole.image_bytes),
             triangles = static_cast<double>(whole.triangles);
  for (const bool quantize : {false, true}) {
    WriteOptions options;
    options.quantize = quantize;
    std::vector<std::byte> file;
    const double encode = seconds([&] { file = encode_levels(model, options, context); });
    const double decode = seconds([&] { read_levels(file, name, {}, {}, context); });
    const auto bytes = static_cast<double>(file.size());
    fmt::print("| {} | {} | {} | {} | {:.3f} | {:.3f} | {:.1f} | {:.2f} | {:.2f} |\n", name, whole.triangles,
               counts(coarsest(model)).triangles, quantize ? "yes" : "no", 1e-6 * bytes, 1e-6 * images,
               (bytes - images) / triangles, encode, decode);
  }
}

/// What a level is off by, against what its record says.
void print_errors(const std::string& name, const Leveled& model, const Context& context) {
  const double diagonal = bounds(model.original).diagonal();
  const Surface original = scene_surface(model.original, rest_pose(model.original)).surface;
  for (const double error : {3e-4, 1e-3, 3e-3, 1e-2}) {
    const Cut cut = cut_at_error(model.levels, error * diagonal);
    const Model level = level_of(model.original, model.levels, cut);
    const SurfaceDistance d =
        surface_distance(original, scene_surface(level, rest_pose(level)).surface, kSamples, context);
    fmt::print("| {} | {:.2f} % | {} | {:.4f} % | {:.4f} % | {:.4f} % | {:.2f} |\n", name, 100 * error,
               triangles_of(model.levels, cut), 100 * d.forward.max / diagonal,
               100 * d.backward.max / diagonal, 100 * d.mean() / diagonal,
               d.hausdorff() / (error * diagonal));
    std::fflush(stdout);
  }
}

/// Which vertices lie in a ball.
std::vector<char> ball(const Surface& surface, Vec3d center, double radius) {
  std::vector<char> inside(surface.positions.size());
  for (std::uint32_t v = 0; v < inside.size(); ++v) inside[v] = length(surface.position(v) - center) < radius;
  return inside;
}

/// What a level is off by in a ball that allows a share of the error of the rest, from both sides.
void print_regions(const std::string& name, const Leveled& model, const Context& context) {
  const Surface original = scene_surface(model.original, rest_pose(model.original)).surface;
  const double diagonal = bounds(model.original).diagonal();
  const ClosestPoint to_original(original);
  for (const double elsewhere : {0.003, 0.02}) {
    for (const double factor : {0.0, 0.05, 0.25}) {
      const std::vector<char> inside = ball(original, original.position(0), 0.1 * diagonal);
      std::vector<float> allowed(inside.size());
      for (std::size_t v = 0; v < allowed.size(); ++v)
        allowed[v] = static_cast<float>(diagonal * elsewhere * (inside[v] != 0 ? factor : 1));
      Surface region;
      region.positions = original.positions;
      std::vector<char> in_region(original.triangles.size());
      for (std::size_t f = 0; f < in_region.size(); ++f) {
        const auto& t = original.triangles[f];
        in_region[f] = inside[t[0]] != 0 || inside[t[1]] != 0 || inside[t[2]] != 0;
        if (in_region[f] != 0) region.triangles.push_back(t);
      }
      const Cut cut = cut_within(model.levels, allowed);
      const Model level = level_of(model.original, model.levels, cut);
      const Surface made = scene_surface(level, rest_pose(level)).surface;
      const ClosestPoint to_made(made);
      double lost = 0, added = 0;
      for (const Vec3d p : sample_surface(region, kSamples, context.seed))
        lost = std::max(lost, to_made.nearest(p).distance);
      for (const Vec3d p : sample_surface(made, kSamples, context.seed)) {
        const ClosestPoint::Hit hit = to_original.nearest(p);
        if (in_region[hit.triangle] != 0) added = std::max(added, hit.distance);
      }
      fmt::print("| {} | {:.1f} % | {} | {} | {} | {} | {:.4f} % | {:.4f} % | {:.4f} % |\n", name,
                 100 * elsewhere, factor, region.triangles.size(),
                 triangles_of(model.levels, cut_at_error(model.levels, elsewhere * diagonal)),
                 triangles_of(model.levels, cut), 100 * elsewhere * factor, 100 * lost / diagonal,
                 100 * added / diagonal);
      std::fflush(stdout);
    }
  }
}

/// Random balls, errors and shares: whether every level is a mesh as whole as the original.
void print_queries(const std::string& name, const Leveled& model, int count) {
  constexpr int kWhole = 50;  // Of so many levels one is looked at as a whole.
  const Surface original = scene_surface(model.original, rest_pose(model.original)).surface;
  const double diagonal = bounds(model.original).diagonal();
  Random random(11);
  LiveLevel live(model.original, model.levels);
  LevelCheck check(model.original, model.levels, live);
  const LevelFaults before = check.update();
  LevelFaults most, all;
  int different = 0;
  std::uint64_t triangles = 0;
  double query = 0, jump = 0, slowest_query = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3d center =
        original.position(random.below(static_cast<std::uint32_t>(original.positions.size())));
    const std::vector<char> inside = ball(original, center, diagonal * random.uniform(0.01, 0.3));
    const double elsewhere = diagonal * std::pow(10.0, random.uniform(-3.5, -1.5)), factor = random.uniform();
    std::vector<float> allowed(inside.size());
    for (std::size_t v = 0; v < allowed.size(); ++v)
      allowed[v] = static_cast<float>(elsewhere * (inside[v] != 0 ? factor * factor : 1));
    Cut cut;
    const double took = seconds([&] { cut = cut_within(model.levels, allowed); });
    query += took;
    slowest_query = std::max(slowest_query, took);
    jump += seconds([&] { live.go_to(cut); });
    const LevelFaults faults = check.update();
    most.cracks = std::max(most.cracks, faults.cracks);
    most.non_manifold = std::max(most.non_manifold, faults.non_manifold);
    most.doubled = std::max(most.doubled, faults.doubled);
    all.turned += faults.turned;
    all.flipped += faults.flipped;
    triangles += live.triangle_count();
    if (i % kWhole == 0) different += !check.is_same(level_of(model.original, model.levels, cut));
  }
  fmt::print("| {} | {} | {} | {} | {} : {} | {} : {} | {:.4f} % | {} | {:.1f} | {:.1f} | {:.1f} |\n", name,
             count, different, most.cracks, most.non_manifold, before.non_manifold, most.doubled,
             before.doubled, 100 * static_cast<double>(all.turned) / static_cast<double>(triangles),
             all.flipped, 1e3 * query / count, 1e3 * slowest_query, 1e3 * jump / count);
}

/// A focus that moves a little from query to query, as an eye does.
void print_motion(const std::string& name, const Leveled& model) {
  const Surface original = scene_surface(model.original, rest_pose(model.original)).surface;
  const double diagonal = bounds(model.original).diagonal();
  LiveLevel live(model.original, model.levels);
  constexpr int kSteps = 50;
  double query = 0, change = 0, slowest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const Vec3d center = original.position(0) + Vec3d{0.002 * diagonal * i, 0, 0};
    std::vector<float> allowed(live.cut().empty() ? 0 : model.levels.first_vertex.back());
    const std::vector<char> inside = ball(original, center, 0.15 * diagonal);
    for (std::size_t v = 0; v < allowed.size(); ++v)
      allowed[v] = static_cast<float>(diagonal * 0.01 * (inside[v] != 0 ? 0.02 : 1));
    Cut cut;
    const double q = seconds([&] { cut = cut_within(model.levels, allowed); });
    const double c = seconds([&] { live.go_to(cut); });
    if (i == 0) continue;
    query += q;
    change += c;
    slowest = std::max(slowest, q + c);
  }
  fmt::print("| {} | {} | {} | {:.1f} | {:.1f} | {:.1f} |\n", name, model.levels.triangles,
             live.triangle_count(), 1e3 * query / kSteps, 1e3 * change / kSteps, 1e3 * slowest);
}

int run(std::vector<std::string> names) {
  const int queries = std::stoi(take_option(names, "--queries").value_or("0"));
  std::vector<Subject> subjects = speed_subjects();
  std::erase_if(subjects, [&](const Subject& s) {
    return !names.empty() && std::find(names.begin(), names.end(), s.name) == names.end();
  });
  Context context;
  context.threads = kThreads;
  for (const Subject& subject : subjects) {
    const Leveled model = make_leveled(subject, context);
    fmt::print(
        "| model | triangles | steps | longest chain | simplify s | build s | bytes | query ms | read ms | "
        "left |\n");
    print_costs(subject.name, model);
    fmt::print(
        "\n| model | triangles | coarsest | quantized | file, MB | images, MB | the rest, bytes per triangle "
        "| encode s | decode s |\n");
    print_file(subject.name, model, context);
    fmt::print(
        "\n| model | elsewhere | factor | triangles in the ball | left without it | left | allowed | lost | "
        "added |\n");
    print_regions(subject.name, model, context);
    fmt::print("\n| model | triangles | left | query ms | change ms | slowest, both |\n");
    print_motion(subject.name, model);
    if (queries > 0) {
      fmt::print(
          "\n| model | queries | unlike the level read whole | cracks | non-manifold edges, original's | "
          "doubled "
          "triangles, original's | turned | flipped | query ms | slowest | change ms |\n");
      print_queries(subject.name, model, queries);
    }
    fmt::print("\n| model | allowed | triangles | lost | added | mean | measured : allowed |\n");
    print_errors(subject.name, model, context);
  }
  return 0;
}

}  // namespace
}  // namespace fovea::bench

int main(int argc, char** argv) { return fovea::bench::run(std::vector<std::string>(argv + 1, argv + argc)); }
