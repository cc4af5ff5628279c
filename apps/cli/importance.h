#pragma once

#include <string>

#include "fovea/io/read.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

namespace fovea::cli {

/// The importance that `--importance SOURCE` names: a file of numbers if there is one of that name or
/// it ends in .npy, .csv or .txt, else a vertex attribute of the model. Throws what io/field_file.h
/// throws, with the option or the file as place.
Importance load_importance(const std::string& source, const Model& model, const ReadOptions& options);

}  // namespace fovea::cli
