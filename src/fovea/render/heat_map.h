#pragma once

#include <string>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/model/model.h"

namespace fovea {

/// The model with numbers per vertex as the only colours of its surface (`heat_color`, as vertex colours on
/// one rough white material), for any viewer. Shape, nodes, skins and animations stay; materials, textures
/// and images go. `fields`, [#meshes][#V], 0 … 1. O(#V + #F).
Model heat_map(const Model& model, const std::vector<VertexField>& fields);

/// The model with the fields as one more vertex attribute of its meshes; `name` begins with "_", as glTF
/// wants of attributes that it does not know. Replaces one of that name.
Model with_attribute(const Model& model, const std::vector<VertexField>& fields, const std::string& name);

}  // namespace fovea
