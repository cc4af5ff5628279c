// What the measures of a collapse's cost do for pictures, and what they cost, as Markdown; an hour.
// metric_bench [--from] [--kept RATIO] [--gltfpack FILE] [MODEL-NAME...]
//   --from      how soon the image should begin to decide
//   --kept      one share of the triangles instead of all five
//   --gltfpack  that program beside ours

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/judge/compare.h"
#include "fovea/simplify/simplify.h"
#include "measure.h"
#include "subjects.h"
#include "words.h"

namespace fovea::bench {
namespace {

/// A simplified model and what it cost.
struct Result {
  Model model;
  double seconds = 0;  ///< CPU time over all threads.
};

/// A way to simplify; the first of a table is what the others are held against.
struct Way {
  std::string name;
  std::function<Result(const Model&, double ratio)> simplify;
};

constexpr double kAll = 1e6;  // more times the target than there are triangles

Way ours(std::string name, Metric metric, std::optional<double> from = {}) {
  return {std::move(name), [=](const Model& model, double ratio) {
            Context context;
            context.threads = 2;
            SimplifyOptions options;
            options.ratio = ratio;
            options.metric = metric;
            options.metric_from = from;
            const double start = cpu_seconds();
            Result result{simplify(model, options, {}, context).model};
            result.seconds = cpu_seconds() - start;
            return result;
          }};
}

/// The program, files read and written. It stops early where it finds nothing more to collapse.
Way gltfpack(const std::string& program, const std::vector<std::string>& settings) {
  return {fmt::format("gltfpack {}", fmt::join(settings, " ")), [=](const Model& model, double ratio) {
            namespace fs = std::filesystem;
            const fs::path folder = fs::temp_directory_path();
            const fs::path before = folder / fmt::format("metric_bench_{}.glb", getpid());
            const fs::path after = folder / fmt::format("metric_bench_{}_packed.glb", getpid());
            Context context;
            WriteOptions write;
            write.force = true;
            write_model(model, before, write, context);
            std::vector<std::string> words{
                program, "-i", before, "-o", after, "-si", fmt::format("{}", ratio), "-se", "1", "-noq"};
            words.insert(words.end(), settings.begin(), settings.end());
            Result result;
            result.seconds = measure_command(words, 1).cpu_seconds;
            result.model = read_model(after, {}, context);
            fs::remove(before);
            fs::remove(after);
            return result;
          }};
}

std::vector<Way> all_metrics() {
  return {ours("quadric", Metric::quadric),   ours("auto", Metric::automatic),
          ours("image", Metric::image, kAll), ours("visibility", Metric::visibility),
          ours("entropy", Metric::entropy),   ours("polygon-entropy", Metric::polygon_entropy)};
}

std::vector<Way> all_starts() {
  std::vector<Way> ways{ours("quadric", Metric::quadric)};
  for (const double from : {1.25, 1.5, 2.0, 3.0, 4.0, 6.0})
    ways.push_back(ours(fmt::format("image from {}", from), Metric::image, from));
  ways.push_back(ours("image", Metric::image, kAll));
  return ways;
}

/// How near a result is to the original, and what it cost.
struct Score {
  std::array<double, 2> psnr{}, flip{};  // base colour, lit
  double seconds = 0;
  double kept = 0;  // Share of the triangles.
};

/// One score for each way. Pictures are taken from views that no metric looked at.
std::vector<Score> scores(const Model& model, const std::vector<Way>& ways, double ratio) {
  std::vector<Result> results;
  for (const Way& way : ways) results.push_back(way.simplify(model, ratio));
  std::vector<const Model*> tests;
  for (const Result& result : results) tests.push_back(&result.model);
  CompareOptions judge;
  judge.size = 256;
  judge.views.set = ViewSet::fibonacci;
  judge.views.count = 23;
  judge.distance_samples = 100;
  Context context;
  context.threads = 2;
  const std::vector<Comparison> found = compare(model, tests, judge, context);
  std::vector<Score> all;
  for (std::size_t i = 0; i < found.size(); ++i) {
    Score& score = all.emplace_back();
    score.seconds = results[i].seconds;
    score.kept = static_cast<double>(triangle_count(*tests[i])) / static_cast<double>(triangle_count(model));
    for (std::size_t p = 0; p < 2; ++p) {
      score.psnr[p] = found[i].passes[p].psnr;
      score.flip[p] = found[i].passes[p].flip;
    }
  }
  return all;
}

void print_ratio(const std::vector<Subject>& subjects, const std::vector<Way>& ways, double ratio) {
  std::vector<Score> sum(ways.size());
  std::vector<int> better(ways.size());
  const auto n = static_cast<double>(subjects.size());
  for (const Subject& subject : subjects) {
    const std::vector<Score> found = scores(subject.make(), ways, ratio);
    std::string line = fmt::format("{} at {}:", subject.name, ratio);
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (std::size_t p = 0; p < 2; ++p) {
        sum[i].psnr[p] += (found[i].psnr[p] - found[0].psnr[p]) / n;
        sum[i].flip[p] += std::log(found[i].flip[p] / found[0].flip[p]) / n;
        better[i] += found[i].flip[p] < found[0].flip[p];
      }
      sum[i].seconds += found[i].seconds / n;
      sum[i].kept += found[i].kept / n;
      line += fmt::format(" {} {:.3f} {:.2f} {:.2f} dB {:.4f} {:.4f} {:.2f} s;", ways[i].name, found[i].kept,
                          found[i].psnr[0], found[i].psnr[1], found[i].flip[0], found[i].flip[1],
                          found[i].seconds);
    }
    fmt::print(stderr, "metric_bench: {}\n", line);
  }
  for (std::size_t i = 0; i < ways.size(); ++i) {
    fmt::print("| {} % | {} | {:+.2f} | {:+.2f} | {:.3f} | {:.3f} | {} of {} | {:.1f} % | {:.2f} |\n",
               100 * ratio, ways[i].name, sum[i].psnr[0], sum[i].psnr[1], std::exp(sum[i].flip[0]),
               std::exp(sum[i].flip[1]), better[i], 2 * subjects.size(), 100 * sum[i].kept, sum[i].seconds);
  }
  std::fflush(stdout);
}

int run(int count, char** arguments) {
  try {
    std::vector<std::string> words(arguments + 1, arguments + count);
    std::vector<Way> ways = std::erase(words, "--from") > 0 ? all_starts() : all_metrics();
    std::vector<double> ratios{0.5, 0.25, 0.1, 0.05, 0.02};
    if (const auto kept = take_option(words, "--kept")) ratios = {std::stod(*kept)};
    if (const auto program = take_option(words, "--gltfpack")) {
      ways.push_back(gltfpack(*program, {"-sv"}));
      ways.push_back(gltfpack(*program, {"-sv", "-sp"}));
    }
    std::vector<Subject> subjects = textured_subjects();
    std::erase_if(subjects, [&](const Subject& subject) {
      return !words.empty() && std::find(words.begin(), words.end(), subject.name) == words.end();
    });
    fmt::print(
        "Against `quadric` at equal triangles, 23 views of 256² that no metric looked at: mean difference of "
        "PSNR (dB), geometric mean of the ratio of FLIP (below 1 is better), in how many pictures FLIP is "
        "better, mean share of the triangles that is left, mean CPU seconds of simplification (of gltfpack: "
        "of "
        "the whole command); {} models.\n\n"
        "| kept | metric | PSNR base | lit | FLIP base | lit | better | left | CPU s |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|\n",
        subjects.size());
    for (const double ratio : ratios) print_ratio(subjects, ways, ratio);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "metric_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** arguments) { return fovea::bench::run(count, arguments); }
