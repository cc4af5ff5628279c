// What a record of levels costs and holds, as Markdown.
// levels_bench [MODEL-NAME...]   building it, queries, and errors against the original; minutes

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "fovea/judge/surface_distance.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/simplify/simplify.h"
#include "fovea/surface/pose.h"
#include "fovea/surface/scene_surface.h"
#include "subjects.h"

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
struct Leveled {
  Model original;
  MultiTessellation levels;
  double simplify_seconds = 0, build_seconds = 0;
};

Leveled make_leveled(const Subject& subject, Context& context) {
  Leveled result;
  result.original = subject.make();
  SimplifyOptions options;
  options.metric = Metric::quadric;
  options.ratio = kCoarsest;
  if (getenv("HALF")) options.placement = Placement::half_edge;
  CollapseRecord record;
  result.simplify_seconds = seconds([&] { record = simplify(result.original, options, {}, context).record; });
  result.build_seconds = seconds(
      [&] { result.levels = make_multi_tessellation(result.original, std::move(record), context); });
  return result;
}

void print_costs(const std::string& name, const Leveled& model) {
  const MultiTessellation& levels = model.levels;
  const auto triangles = static_cast<double>(levels.triangles);
  const double diagonal = bounds(model.original).diagonal();
  std::vector<float> allowed(levels.first_vertex.back(), static_cast<float>(1e-3 * diagonal));
  Cut cut;
  const double query = seconds([&] { cut = cut_within(levels, allowed); });
  const double read = seconds([&] { level_of(model.original, levels, cut); });
  fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.0f} | {:.1f} | {:.0f} | {} |\n", name, levels.triangles,
             levels.step_count(), model.simplify_seconds, model.build_seconds,
             static_cast<double>(levels.bytes()) / triangles, 1e3 * query, 1e3 * read, triangles_of(levels, cut));
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
               triangles_of(model.levels, cut), 100 * d.forward.max / diagonal, 100 * d.backward.max / diagonal,
               100 * d.mean() / diagonal, d.hausdorff() / (error * diagonal));
    std::fflush(stdout);
  }
}

/// A ball that stays as it is, all else as coarse as it may be.
void print_focus(const std::string& name, const Leveled& model) {
  const Surface original = scene_surface(model.original, rest_pose(model.original)).surface;
  const Box box = bounds(model.original);
  for (const double radius : {0.05, 0.1, 0.2}) {
    for (const double elsewhere : {0.003, 0.01, 0.1}) {
      std::vector<float> allowed(model.levels.first_vertex.back(), static_cast<float>(elsewhere * box.diagonal()));
      const Vec3d center = original.position(0);
      const auto inside = [&](std::uint32_t v) { return length(original.position(v) - center) < radius * box.diagonal(); };
      for (std::uint32_t v = 0; v < allowed.size(); ++v) {
        if (inside(v)) allowed[v] = 0;
      }
      std::uint64_t kept = 0;
      for (const auto& t : original.triangles) kept += inside(t[0]) || inside(t[1]) || inside(t[2]);
      const Cut cut = cut_within(model.levels, allowed), plain = cut_at_error(model.levels, elsewhere * box.diagonal());
      fmt::print("| {} | {} | {} | {} | {} | {} |\n", name, radius, elsewhere, kept, triangles_of(model.levels, plain),
                 triangles_of(model.levels, cut));
    }
  }
}

int run(const std::vector<std::string>& names) {
  std::vector<Subject> subjects = speed_subjects();
  std::erase_if(subjects, [&](const Subject& s) {
    return !names.empty() && std::find(names.begin(), names.end(), s.name) == names.end();
  });
  Context context;
  context.threads = kThreads;
  for (const Subject& subject : subjects) {
    const Leveled model = make_leveled(subject, context);
    fmt::print("| model | triangles | steps | simplify s | build s | bytes | query ms | read ms | left |\n");
    print_costs(subject.name, model);
    fmt::print("\n| model | radius | elsewhere | triangles in the ball | without it | left |\n");
    print_focus(subject.name, model);
    fmt::print("\n| model | allowed | triangles | lost | added | mean | measured : allowed |\n");
    print_errors(subject.name, model, context);
  }
  return 0;
}

}  // namespace
}  // namespace fovea::bench

int main(int argc, char** argv) { return fovea::bench::run(std::vector<std::string>(argv + 1, argv + argc)); }
