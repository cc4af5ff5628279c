#pragma once

#include "fovea/model/model.h"

/// Models with images, for what works on textures.
namespace fovea::test {

/// The mesh in a scene; its material 0, which parts without one get, has base
/// colour image 0 and, if there are two images, normal map image 1; each 64 × 64, a picture that fills it, in
/// a PNG.
Model textured(TriMesh mesh, int images);

/// A plane of 162 triangles, each with a small chart of its own, of grey noise, in an image whose texels
/// between the charts are squares of black and white, an eightieth of its side.
Model small_charts(int side);

}  // namespace fovea::test
