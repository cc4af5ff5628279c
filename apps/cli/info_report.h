#pragma once

#include <string>

#include "inspect.h"
#include "report.h"

namespace fovea::cli {

/// What `info` found, for --json: "totals", "bounds", "meshes", "materials", "images", ...
void add_info_json(Json& report, const Model& model, const ModelFacts& facts, const Snapshot& totals);

/// The same for people: aligned tables. Long lists are cut with a word unless `everything`.
std::string info_text(const std::string& path, const Model& model, const ModelFacts& facts,
                      const Snapshot& totals, bool everything);

}  // namespace fovea::cli
