#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/lod/lod_chain.h"
#include "fovea/model/model.h"

namespace fovea {

/// All levels of a chain in one model, as MSFT_lod has them. Whoever does not know the extension shows level
/// 0.
///
/// Each node that shows a mesh that changes names the nodes of levels 1, 2, ... in "ids"; "extras" get
/// "MSFT_screencoverage": at which part of the screen's area, of the sphere around what the node shows, each
/// level gives way to the next, and at last (`vanish`, a coverage; 0 for never) to nothing. Nodes of levels
/// stand in no scene: they take the place of the node that names them, below the same parent, so they have
/// the same transform and instances. Where others depend on the node itself (children, joints, lights,
/// cameras, animation of its transform, extensions), its mesh moves to a child without a transform of its
/// own, and that names the levels: whatever moves the node moves them all. Levels share skins; animations of
/// morph weights are repeated for each. No element of the original gets another index.
///
/// Levels share what is equal: images, textures, materials, meshes. Materials whose images differ are copied,
/// also for variants (KHR_materials_variants). Pointers of KHR_animation_pointer lead to level 0 alone
/// ("lod-pointer").
///
/// `level_of` receives of which mesh of the original each mesh is a level, -1 for those of the original: for
/// `write_gltf`, so that levels are made of the same vertices. Half-edge collapses leave few that a level
/// does not share with the one before.
Model with_lods(const LodChain& chain, double vanish, Context& context, std::vector<int>* level_of = nullptr);

}  // namespace fovea
