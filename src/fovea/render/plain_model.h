#pragma once

#include <string>

#include "fovea/model/model.h"

// Private to render/.

namespace fovea {

/// The model with one rough white material of that name, without textures and images. Shape, nodes, skins and
/// animations stay, of its attributes normals and what skins need. O(#V + #F).
Model plain_model(const Model& model, const std::string& material);

/// Removes a custom attribute of that name.
void remove_attribute(TriMesh& mesh, const std::string& name);

}  // namespace fovea
