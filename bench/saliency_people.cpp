// How well saliency agrees with where people looked, for every model of a folder that has such a map, as
// Markdown or JSON (docs/people.md).
// saliency_people FOLDER [--up x|y|z|-x|-y|-z] [--json] [PREDICTOR...]

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "fovea/saliency/baseline.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/saliency/people_data.h"
#include "fovea/surface/scene_surface.h"

namespace fovea::bench {
namespace {

// --- What predicts ------------------------------------------------------------------------------------

/// Says of each vertex how much it draws the eye: one field per mesh.
struct Predictor {
  std::string name;
  std::function<std::vector<VertexField>(const Model&, Context&)> predict;
};

/// A predictor that sees all meshes as one surface.
template <class F>
Predictor of_surface(std::string name, F predict) {
  return {std::move(name), [predict](const Model& model, Context& context) {
            const SceneSurface scene = scene_surface(model, rest_pose(model));
            return split(scene, predict(scene.surface, context));
          }};
}

Predictor of_saliency(std::string name, const SaliencyOptions& options) {
  return {std::move(name), [options](const Model& model, Context& context) {
            return model_saliency(model, options, context).saliency;
          }};
}

Predictor preset(std::string name, SaliencyPreset preset, UpAxis up) {
  SaliencyOptions options;
  options.preset = preset;
  options.ring.up = up;
  return of_saliency(std::move(name), options);
}

/// One part of the default alone.
Predictor part(std::string name, std::optional<double> SaliencyOptions::*weight, UpAxis up) {
  SaliencyOptions options;
  options.ring.up = up;
  for (const auto other : {&SaliencyOptions::geometry, &SaliencyOptions::texture, &SaliencyOptions::height,
                           &SaliencyOptions::extremity, &SaliencyOptions::visibility})
    options.*other = other == weight ? 1 : 0;
  return of_saliency(std::move(name), options);
}

std::vector<Predictor> all_predictors(UpAxis up) {
  const Vec3d upward = direction(up);
  return {of_surface("uniform",
                     [](const Surface& s, const Context&) { return VertexField(s.positions.size(), 1); }),
          of_surface("centre", near_center),
          of_surface("centre-far", far_from_center),
          of_surface("axis", along_main_axis),
          of_surface("height", [upward](const Surface& s,
                                        const Context& context) { return along(s, upward, context); }),
          preset("lee", SaliencyPreset::lee, up),
          preset("munaretti", SaliencyPreset::munaretti, up),
          preset("yang", SaliencyPreset::yang, up),
          preset("fovea", SaliencyPreset::fovea, up),
          part("fovea-geometry", &SaliencyOptions::geometry, up),
          part("fovea-texture", &SaliencyOptions::texture, up),
          part("fovea-visibility", &SaliencyOptions::visibility, up)};
}

// --- What is asked for --------------------------------------------------------------------------------

struct Task {
  std::filesystem::path folder;
  UpAxis up = UpAxis::y;
  bool json = false;
  std::vector<std::string> only;  ///< Names of predictors; all if empty.
};

constexpr const char* kUsage = "saliency_people FOLDER [--up x|y|z|-x|-y|-z] [--json] [PREDICTOR...]";

UpAxis read_axis(const std::string& word) {
  static constexpr const char* kNames[] = {"x", "y", "z", "-x", "-y", "-z"};  // in the order of UpAxis
  const auto at = std::find(std::begin(kNames), std::end(kNames), word);
  if (at == std::end(kNames))
    throw Error(ErrorKind::usage, fmt::format("--up: \"{}\" is not one of x, y, z, -x, -y, -z", word));
  return static_cast<UpAxis>(at - std::begin(kNames));
}

Task read_task(const std::vector<std::string>& words) {
  Task task;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--json") {
      task.json = true;
    } else if (words[i] == "--up" && i + 1 < words.size()) {
      task.up = read_axis(words[++i]);
    } else if (words[i].starts_with("-")) {
      throw Error(ErrorKind::usage, fmt::format("\"{}\" is not understood: {}", words[i], kUsage));
    } else if (task.folder.empty()) {
      task.folder = words[i];
    } else {
      task.only.push_back(words[i]);
    }
  }
  if (task.folder.empty()) throw Error(ErrorKind::usage, kUsage);
  return task;
}

std::vector<Predictor> choose_predictors(const Task& task) {
  std::vector<Predictor> all = all_predictors(task.up);
  if (task.only.empty()) return all;
  std::vector<Predictor> chosen;
  for (const std::string& name : task.only) {
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Predictor& p) { return p.name == name; });
    if (known == all.end()) throw Error(ErrorKind::usage, fmt::format("there is no predictor \"{}\"", name));
    chosen.push_back(*known);
  }
  return chosen;
}

// --- Scores -------------------------------------------------------------------------------------------

struct Measure {
  const char* name;
  const char* key;
  double Agreement::*value;
};
constexpr std::array<Measure, 6> kMeasures = {{{"LCC", "correlation", &Agreement::correlation},
                                               {"Spearman", "spearman", &Agreement::spearman},
                                               {"AUC", "auc", &Agreement::auc},
                                               {"NSS", "nss", &Agreement::nss},
                                               {"KL", "kl", &Agreement::kl},
                                               {"SIM", "similarity", &Agreement::similarity}}};

/// A model with how each predictor did on it.
struct Row {
  std::string name;
  PeopleMap map;
  std::vector<Agreement> scores;  ///< [#predictors]
};

Row score(const PeopleFiles& files, const std::vector<Predictor>& predictors) {
  Context context;
  const Model model = read_model(files.model, {}, context);
  Row row{files.name, read_people_map(files, model), {}};
  const Surface surface = scene_surface(model, rest_pose(model)).surface;
  try {
    for (const Predictor& predictor : predictors)
      row.scores.push_back(agreement(joined(predictor.predict(model, context)), row.map, surface, context));
  } catch (const Error& error) {
    throw error.within(files.map.string());
  }
  return row;
}

std::vector<Agreement> mean_scores(const std::vector<Row>& rows) {
  std::vector<Agreement> means(rows.at(0).scores.size());
  for (std::size_t p = 0; p < means.size(); ++p) {
    for (const Measure& measure : kMeasures) {
      double sum = 0;
      for (const Row& row : rows) sum += row.scores[p].*measure.value;
      means[p].*measure.value = sum / static_cast<double>(rows.size());
    }
  }
  return means;
}

// --- What is printed ----------------------------------------------------------------------------------

const char* over_text(const PeopleMap& map) {
  return map.over == PeopleMap::Over::faces ? "faces" : "vertices";
}

/// Three decimals, without a sign at nothing.
std::string score_text(double score) {
  const double rounded = std::round(1000 * score) / 1000;
  return fmt::format("{:.3f}", rounded == 0 ? 0.0 : rounded);
}

void print_table(const std::string& title, const std::vector<Predictor>& predictors,
                 const std::vector<Agreement>& scores) {
  fmt::print("**{}**\n\n| predictor |", title);
  for (const Measure& measure : kMeasures) fmt::print(" {} |", measure.name);
  fmt::print("\n|---|--:|--:|--:|--:|--:|--:|\n");
  for (std::size_t p = 0; p < predictors.size(); ++p) {
    fmt::print("| {} |", predictors[p].name);
    for (const Measure& measure : kMeasures) fmt::print(" {} |", score_text(scores[p].*measure.value));
    fmt::print("\n");
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void print_row(const Row& row, const std::vector<Predictor>& predictors) {
  std::string title = fmt::format("{}: {} {}", row.name, row.map.values.size(), over_text(row.map));
  if (row.map.points > 0)
    title += fmt::format(", {} of {} points at no vertex", row.map.strays, row.map.points);
  print_table(title, predictors, row.scores);
}

using Json = nlohmann::ordered_json;

Json to_json(const std::vector<Predictor>& predictors, const std::vector<Agreement>& scores) {
  Json json = Json::object();
  for (std::size_t p = 0; p < predictors.size(); ++p) {
    for (const Measure& measure : kMeasures) json[predictors[p].name][measure.key] = scores[p].*measure.value;
  }
  return json;
}

Json to_json(const Row& row, const std::vector<Predictor>& predictors) {
  return {
      {"name", row.name},         {"over", over_text(row.map)}, {"elements", row.map.values.size()},
      {"points", row.map.points}, {"strays", row.map.strays},   {"scores", to_json(predictors, row.scores)}};
}

void print_json(const std::vector<Row>& rows, const std::vector<Predictor>& predictors,
                const std::vector<std::string>& errors) {
  Json json{{"models", Json::array()}, {"mean", nullptr}, {"errors", errors}};
  for (const Row& row : rows) json["models"].push_back(to_json(row, predictors));
  if (!rows.empty()) json["mean"] = to_json(predictors, mean_scores(rows));
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

/// The exit code.
int run(const Task& task) {
  const std::vector<Predictor> predictors = choose_predictors(task);
  std::vector<Row> rows;
  std::vector<std::string> errors;
  int code = 0;
  for (const PeopleFiles& files : find_people_files(task.folder)) {
    try {
      rows.push_back(score(files, predictors));
      if (!task.json) print_row(rows.back(), predictors);
    } catch (const Error& error) {
      errors.emplace_back(error.what());
      fmt::print(stderr, "saliency_people: {}\n", error.what());
      if (code == 0) code = exit_code(error.kind());
    }
  }
  if (task.json) {
    print_json(rows, predictors, errors);
  } else if (!rows.empty()) {
    print_table(fmt::format("mean of {} models", rows.size()), predictors, mean_scores(rows));
  }
  return code;
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** words) {
  using namespace fovea;
  try {
    return bench::run(bench::read_task({words + 1, words + count}));
  } catch (const Error& error) {
    fmt::print(stderr, "saliency_people: {}\n", error.what());
    return exit_code(error.kind());
  }
}
