#include "input.h"

#include "fovea/lod/levels_file.h"
#include "report.h"

namespace fovea::cli {

namespace {

/// The levels of a file; if it has none, the model goes to `input` alone.
std::optional<LeveledModel> read_leveled(Input& input, const ReadOptions& options, Context& context) {
  const std::string& path = input.path;
  const LevelsPlace place = find_levels(path);
  if (place == LevelsPlace::file)
    return read_levels(read_file(path, options.max_file_bytes), path, {}, options, context);
  input.model = read_model(path, options, context);
  if (place == LevelsPlace::none) return std::nullopt;
  return about(path, [&] { return levels_inside(input.model, {}, options, context); });
}

}  // namespace

Input read_input(Session& session, const std::string& path, const ReadOptions& options) {
  return session.phase("read", [&] {
    Input input{path, {}, {}, {}};
    if (std::optional<LeveledModel> leveled = read_leveled(input, options, session.context)) {
      input.model = std::move(leveled->original);
      input.levels = std::move(leveled->levels);
    }
    if (counts(input.model).triangles == 0)
      session.context.report("no-triangles", "the model has no triangles", path);
    input.bytes = measure_input(path, input.model);
    return input;
  });
}

void need_triangles(const Input& input) {
  const ModelCounts found = counts(input.model);
  if (found.triangles_drawn > 0) return;
  throw Error(ErrorKind::unsupported,
              found.triangles > 0 ? "the model's scene shows no triangles" : "the model has no triangles",
              input.path);
}

Json inputs_json(std::span<const Input> inputs) {
  Json json = Json::array();
  for (const Input& input : inputs) json.push_back(file_json(input.path, input.bytes));
  return json;
}

}  // namespace fovea::cli
