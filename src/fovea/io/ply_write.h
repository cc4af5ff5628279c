#pragma once

#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/write.h"
#include "fovea/model/model.h"

namespace fovea {

/// Encodes a model as binary little-endian PLY: the file itself and, if the model has exactly one base
/// colour image, that image, named in a comment "TextureFile".
///
/// Every instance of every mesh of the scene is written with its world transform, mesh by mesh
/// (rest pose; mirrored ones with their winding turned). Vertices are split: each has x y z and, if
/// any part has them, nx ny nz, s t (origin at the bottom left), red green blue and alpha (bytes,
/// display values) and custom numbers under their names without the underscore. Parts without them get
/// (0, 0, 1), (0, 0), white and 0.
///
/// What the format cannot hold is one diagnostic, "lost-on-export".
std::vector<OutputFile> write_ply(const Model& model, const std::string& stem, Context& context);

}  // namespace fovea
