#pragma once

#include <string>

#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

namespace fovea::cli {

/// The importance that `--importance SOURCE` names: a field file (.npy, .csv) or a vertex attribute of
/// the model. Empty for an empty source. Throws Error(usage) if no mesh has the attribute, with the
/// nearest that one has, or if the file's length fits neither the vertices nor the source vertices;
/// Error of io/field_file.h for the file.
Importance load_importance(const std::string& source, const Model& model);

}  // namespace fovea::cli
