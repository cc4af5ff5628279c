#pragma once

#include <set>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/surface_origin.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Whether all meshes of an atlas have normals: what is shaded flat is lit by its triangles.
bool has_normals(const Model& model, const Atlas& atlas);

/// Makes place for normal maps in atlases whose texels may move and whose meshes have normals: materials
/// without one get a flat one, one for the whole atlas, of the size and the file format of their base colour
/// (or of the atlas's first image), and their parts, if they have no tangents, those that the coordinates
/// give, so that every viewer sees the same frames. Elements are only added. Returns the new images.
std::set<int> add_normal_maps(Model& model, std::span<const Atlas> atlases);

/// The original's normals, bent by its own map (the material's `scale` applied), as a normal map in the
/// frames of the simpler surface, which lies at its own coordinates: so lit, that one looks as the original
/// did. What has no place on the original stays unbent, texels under several triangles get the mean, and
/// between the charts it goes on from what is around.
///
/// O(#texels log #F), parallel. Throws Error(cancelled).
Image8 baked_normals(const SurfaceOrigin& origin, const Model& simplified, const Image8* map, double scale,
                     int width, int height, const Context& context);

}  // namespace fovea
