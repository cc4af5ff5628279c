#pragma once

#include <span>

#include "fovea/model/field.h"
#include "fovea/model/model.h"

namespace fovea {

/// Throws Error(usage) unless there is one field per mesh with a value for each of its vertices.
void check_fields(const Model& model, std::span<const VertexField> fields);

}  // namespace fovea
