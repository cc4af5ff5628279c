// Whole commands, files in and out: `fovea simplify` against gltfpack, as Markdown.
// command_bench FOVEA GLTFPACK OUTPUT-FOLDER [MODEL...]

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/sample/sample.h"
#include "measure.h"
#include "subjects.h"

namespace fovea::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kRepeats = 3;

struct Tools {
  std::string fovea;
  std::string gltfpack;
  fs::path output;
};

/// Textured models of the data folder, or samples written to files first.
std::vector<fs::path> default_models(const fs::path& output) {
  std::vector<fs::path> paths;
  if (const auto folder = data_folder()) {
    for (const char* name :
         {"DamagedHelmet", "WaterBottle", "MaterialsVariantsShoe", "ToyCar", "SheenChair"}) {
      paths.push_back(*folder / "textured" / (std::string(name) + ".glb"));
    }
    return paths;
  }
  for (const SampleInfo& info : samples()) {
    Context context;
    paths.push_back(output / (info.name + ".glb"));
    WriteOptions options;
    options.force = true;
    write_model(make_sample(info.name, 1.0, context), paths.back(), options, context);
  }
  return paths;
}

std::size_t triangles_in(const fs::path& path) {
  Context context;
  return triangle_count(read_model(path, {}, context));
}

std::string left(const fs::path& path) {
  try {
    return std::to_string(triangles_in(path));
  } catch (const Error&) {
    return "–";
  }
}

double megabytes(const Cost& cost) { return static_cast<double>(cost.peak_bytes) / 1e6; }

void print_row(const Tools& tools, const fs::path& model, double ratio, const std::string& metric) {
  const std::string target = fmt::format("{}", ratio);
  const fs::path ours = tools.output / "fovea.glb", theirs = tools.output / "gltfpack.glb";
  const int not_reached = 8;
  const Cost a = measure_command({tools.fovea, "simplify", model.string(), "-o", ours.string(), "--ratio",
                                  target, "--metric", metric, "--threads", "1", "--quiet", "--force"},
                                 kRepeats, {not_reached});
  const Cost b = measure_command(
      {tools.gltfpack, "-i", model.string(), "-o", theirs.string(), "-si", target, "-se", "1", "-sv", "-noq"},
      kRepeats);
  fmt::print(
      "| {} | {} | {:.0f} % | {} | {} / {} | {:.2f} / {:.2f} | {:.2f} / {:.2f} | {:.2f}× | {:.0f} / {:.0f} "
      "|\n",
      model.stem().string(), triangles_in(model), 100 * ratio, metric, left(ours), left(theirs),
      a.cpu_seconds, b.cpu_seconds, a.wall_seconds, b.wall_seconds, b.cpu_seconds / a.cpu_seconds,
      megabytes(a), megabytes(b));
  std::fflush(stdout);
}

void print_table(const Tools& tools, const std::vector<fs::path>& models) {
  fmt::print(
      "Whole commands, start-up and files included; fovea on one thread; best of {}. Above 1× fovea needs "
      "less CPU time.\n\n"
      "| model | triangles | to | metric | left: fovea / gltfpack | CPU s | wall s | fovea : gltfpack | peak "
      "MB |\n"
      "|---|--:|--:|---|---|--:|--:|--:|--:|\n",
      kRepeats);
  for (const fs::path& model : models) {
    for (const double ratio : {0.5, 0.1, 0.02}) {
      for (const char* metric : {"quadric", "auto"}) print_row(tools, model, ratio, metric);
    }
  }
}

int run(int count, char** words) {
  if (count < 4) {
    fmt::print(stderr, "usage: command_bench FOVEA GLTFPACK OUTPUT-FOLDER [MODEL...]\n");
    return exit_code(ErrorKind::usage);
  }
  try {
    const Tools tools{words[1], words[2], words[3]};
    fs::create_directories(tools.output);
    std::vector<fs::path> models(words + 4, words + count);
    if (models.empty()) models = default_models(tools.output);
    print_table(tools, models);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "command_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** words) { return fovea::bench::run(count, words); }
