#pragma once

#include <string>
#include <vector>

#include "fovea/io/read.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"

namespace fovea::cli {

/// The numbers per vertex that an option ("--importance SOURCE") names, for each mesh: a file if there is one
/// of that name or it ends in .npy, .csv or .txt, else a vertex attribute of the model. Throws what
/// io/field_file.h throws, with the option or the file as place.
std::vector<VertexField> load_fields(const std::string& source, const std::string& option, const Model& model,
                                     const ReadOptions& options);

}  // namespace fovea::cli
