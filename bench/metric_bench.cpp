// What the measures of a collapse's cost do for pictures, and what they cost, as Markdown; a quarter of an
// hour. metric_bench [--from] [MODEL-NAME...]; --from: how soon the image should begin to decide.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/judge/compare.h"
#include "fovea/simplify/simplify.h"
#include "subjects.h"

namespace fovea::bench {
namespace {

constexpr double kRatios[] = {0.5, 0.25, 0.1, 0.05, 0.02};

/// A way to simplify; the first of a table is what the others are held against.
struct Way {
  std::string name;
  Metric metric;
  std::optional<double> from;
};
const double kAll = std::numeric_limits<double>::infinity();
const std::vector<Way> kMetrics{
    {"quadric", Metric::quadric, {}}, {"auto", Metric::automatic, {}},
    {"image", Metric::image, kAll},   {"visibility", Metric::visibility, {}},
    {"entropy", Metric::entropy, {}}, {"polygon-entropy", Metric::polygon_entropy, {}}};
const std::vector<Way> kFrom{{"quadric", Metric::quadric, {}},       {"image from 1.25", Metric::image, 1.25},
                             {"image from 1.5", Metric::image, 1.5}, {"image from 2", Metric::image, 2},
                             {"image from 3", Metric::image, 3},     {"image from 4", Metric::image, 4},
                             {"image from 6", Metric::image, 6},     {"image", Metric::image, kAll}};

/// How near a result is to the original, and what it cost.
struct Score {
  std::array<double, 2> psnr{}, flip{};  // base colour, lit
  double seconds = 0;
};

/// One score for each way. Pictures are taken from views that no metric looked at.
std::vector<Score> scores(const Model& model, const std::vector<Way>& ways, double ratio) {
  Context context;
  context.threads = 2;
  std::vector<SimplifyResult> results;
  for (const Way& way : ways) {
    SimplifyOptions options;
    options.ratio = ratio;
    options.metric = way.metric;
    options.metric_from = way.from;
    results.push_back(simplify(model, options, {}, context));
  }
  std::vector<const Model*> tests;
  for (const SimplifyResult& result : results) tests.push_back(&result.model);
  CompareOptions judge;
  judge.size = 256;
  judge.views.set = ViewSet::fibonacci;
  judge.views.count = 23;
  judge.distance_samples = 100;
  const std::vector<Comparison> found = compare(model, tests, judge, context);
  std::vector<Score> all;
  for (std::size_t i = 0; i < found.size(); ++i) {
    Score& score = all.emplace_back();
    score.seconds = results[i].seconds;
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
      line +=
          fmt::format(" {:.2f} {:.2f} dB {:.2f} s;", found[i].psnr[0], found[i].psnr[1], found[i].seconds);
    }
    fmt::print(stderr, "metric_bench: {}\n", line);
  }
  for (std::size_t i = 0; i < ways.size(); ++i) {
    fmt::print("| {} % | {} | {:+.2f} | {:+.2f} | {:.3f} | {:.3f} | {} of {} | {:.2f} |\n", 100 * ratio,
               ways[i].name, sum[i].psnr[0], sum[i].psnr[1], std::exp(sum[i].flip[0]),
               std::exp(sum[i].flip[1]), better[i], 2 * subjects.size(), sum[i].seconds);
  }
  std::fflush(stdout);
}

int run(int count, char** words) {
  try {
    std::vector<std::string> only(words + 1, words + count);
    const bool from = std::erase(only, "--from") > 0;
    std::vector<Subject> subjects = textured_subjects();
    std::erase_if(subjects, [&](const Subject& subject) {
      return !only.empty() && std::find(only.begin(), only.end(), subject.name) == only.end();
    });
    fmt::print(
        "Against `quadric` at equal triangles, 23 views of 256² that no metric looked at: mean difference of "
        "PSNR "
        "(dB), geometric mean of the ratio of FLIP (below 1 is better), in how many pictures FLIP is better, "
        "mean "
        "seconds of simplification, two threads; {} models.\n\n"
        "| kept | metric | PSNR base | lit | FLIP base | lit | better | seconds |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|\n",
        subjects.size());
    for (const double ratio : kRatios) print_ratio(subjects, from ? kFrom : kMetrics, ratio);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "metric_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** words) { return fovea::bench::run(count, words); }
