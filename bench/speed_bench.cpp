// Speed and memory of fovea::simplify against the simplifiers of other libraries, as Markdown.
// speed_bench [--quick | --large] [MODEL-NAME...]

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/simplify/simplify.h"
#include "measure.h"
#include "peers.h"
#include "subjects.h"

namespace fovea::bench {
namespace {

struct Settings {
  int repeats = 3;
  bool large = false;
  std::vector<std::string> only;  ///< Names of subjects; all if empty.
};

/// One row of the table.
struct Case {
  Subject subject;
  double ratio = 0.1;
  bool attributes = false;
  bool with_cgal = true;
  int repeats = 3;
};

std::shared_ptr<const Model> prepare_model(const Case& row) {
  auto model = std::make_shared<Model>(row.subject.make());
  if (row.attributes) {
    add_missing_normals(*model);
  } else {
    keep_positions_only(*model);
  }
  return model;
}

/// In a child like everything else: a process that has started threads must not be forked.
std::uint64_t count_triangles(const Case& row) {
  return measure(
             [&]() -> Work {
               auto model = prepare_model(row);
               return [model] { return triangle_count(*model); };
             },
             1)
      .result;
}

Cost measure_fovea(const Case& row, int threads) {
  return measure(
      [&]() -> Work {
        auto model = prepare_model(row);
        return [model, &row, threads] {
          Context context;
          context.threads = threads;
          SimplifyOptions options;
          options.metric = Metric::quadric;  // as the peers
          options.ratio = row.ratio;
          return simplify(*model, options, {}, context).triangles_after;
        };
      },
      row.repeats);
}

Cost measure_meshopt(const Case& row) {
  return measure([&] { return meshopt_peer(*prepare_model(row), row.ratio, !row.attributes); }, row.repeats);
}

/// CGAL knows no attributes and is far slower than the rest: one run, positions only.
Cost measure_cgal([[maybe_unused]] const Case& row) {
#ifdef FOVEA_BENCH_CGAL
  if (!row.attributes && row.with_cgal) {
    return measure([&] { return cgal_peer(*prepare_model(row), row.ratio); }, 1);
  }
#endif
  return {};
}

std::string rate(double triangles, double seconds) {
  return seconds > 0 ? fmt::format("{:.2f}", 1e-6 * triangles / seconds) : "–";
}

std::string ratio(double ours, double theirs) {
  return ours > 0 && theirs > 0 ? fmt::format("{:.2f}×", theirs / ours) : "–";
}

std::string bytes_each(const Cost& cost, double triangles) {
  return cost.wall_seconds > 0 ? fmt::format("{:.0f}", static_cast<double>(cost.peak_bytes) / triangles)
                               : "–";
}

void print_head() {
  fmt::print(
      "| model | triangles | with | to | left: fovea / meshopt / CGAL | fovea 1 thread | fovea 2 threads | "
      "meshopt | CGAL | fovea : meshopt | fovea : CGAL | fovea bytes | meshopt bytes |\n"
      "|---|--:|---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
}

void print_row(const Case& row) {
  const auto triangles = static_cast<double>(count_triangles(row));
  const Cost one = measure_fovea(row, 1);
  const Cost two = measure_fovea(row, 2);
  const Cost meshopt = measure_meshopt(row);
  const Cost cgal = measure_cgal(row);
  fmt::print("| {} | {:.0f} | {} | {:.0f} % | {} / {} / {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
             row.subject.name, triangles, row.attributes ? "attributes" : "positions", 100 * row.ratio,
             one.result, meshopt.result, cgal.wall_seconds > 0 ? std::to_string(cgal.result) : "–",
             rate(triangles, one.cpu_seconds), rate(triangles, two.wall_seconds),
             rate(triangles, meshopt.cpu_seconds), rate(triangles, cgal.cpu_seconds),
             ratio(one.cpu_seconds, meshopt.cpu_seconds), ratio(one.cpu_seconds, cgal.cpu_seconds),
             bytes_each(one, triangles), bytes_each(meshopt, triangles));
  std::fflush(stdout);
}

bool wanted(const Settings& settings, const Subject& subject) {
  return settings.only.empty() ||
         std::find(settings.only.begin(), settings.only.end(), subject.name) != settings.only.end();
}

void print_table(const Settings& settings) {
  print_head();
  for (const Subject& subject : speed_subjects()) {
    if (!wanted(settings, subject)) continue;
    for (const bool attributes : {false, true}) {
      for (const double target : {0.5, 0.1, 0.02}) {
        print_row({subject, target, attributes, true, settings.repeats});
      }
    }
  }
}

void print_large() {
  print_head();
  for (const double target : {0.5, 0.1, 0.02}) {
    print_row({noise_sphere(10'000'000), target, false, false, 1});
  }
}

Settings parse(int count, char** words) {
  Settings settings;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(words[i], "--large") == 0) {
      settings.large = true;
    } else if (std::strcmp(words[i], "--quick") == 0) {
      settings.repeats = 1;
    } else {
      settings.only.emplace_back(words[i]);
    }
  }
  return settings;
}

int run(int count, char** words) {
  try {
    const Settings settings = parse(count, words);
    fmt::print(
        "Million input triangles per second of the whole library call: CPU time for one thread, wall time "
        "for "
        "two; best of {}. Above 1× fovea is faster. Bytes: highest resident memory of the call beyond its "
        "input, per input triangle.\n\n",
        settings.large ? 1 : settings.repeats);
    if (settings.large) {
      print_large();
    } else {
      print_table(settings);
    }
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "speed_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** words) { return fovea::bench::run(count, words); }
