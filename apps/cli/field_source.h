#pragma once

#include <string>
#include <vector>

#include "fovea/model/field.h"
#include "input.h"

namespace fovea::cli {

/// Numbers per vertex as an option ("--importance SOURCE") names them, for each mesh.
struct NamedFields {
  std::vector<VertexField> fields;
  std::string path;  ///< The file that holds them: a list of numbers, or the model.
};

/// A file if there is one of that name or it ends in .npy, .csv or .txt, else a vertex attribute of the
/// model. Throws what io/field_file.h throws, with the file as place.
NamedFields load_fields(const std::string& source, const Input& input, const ReadOptions& options);

}  // namespace fovea::cli
