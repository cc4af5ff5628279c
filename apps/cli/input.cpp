#include "input.h"

#include "report.h"

namespace fovea::cli {

Input read_input(Session& session, const std::string& path, const ReadOptions& options) {
  return session.phase("read", [&] {
    Model model = read_model(path, options, session.context);
    if (counts(model).triangles == 0)
      session.context.report("no-triangles", "the model has no triangles", path);
    const FileBytes bytes = measure_input(path, model);
    return Input{path, std::move(model), bytes};
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
