#pragma once

#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/write.h"
#include "fovea/model/model.h"

namespace fovea {

/// Encodes a model as Wavefront OBJ: the file itself, `stem`.mtl if there is a material, and the
/// images that materials use.
///
/// Every instance of every mesh of the scene is written with its world transform, mesh by mesh
/// (rest pose; mirrored ones with their winding turned). Positions are shared, texture coordinates
/// and normals have tables of their own, so that a seam cuts only what it must. Numbers are the
/// shortest that read back as the same float. Texture coordinates are those of a material's base
/// colour, its texture transform worked in. Materials keep colour, opacity, emission, roughness
/// (as Ns and Pr), metal (Pm), and the base colour, normal and emission images.
///
/// What the format cannot hold (skins, animations, morph targets, further attributes, points and
/// lines, other maps) is one diagnostic, "lost-on-export".
std::vector<OutputFile> write_obj(const Model& model, const std::string& stem, Context& context);

}  // namespace fovea
