#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/gltf_column.h"
#include "fovea/model/model.h"

// Private to io: where positions on integer grids get their size back.

namespace fovea::gltf {

/// How a model changes so that meshes with integer positions look as before.
struct QuantizationPlan {
  std::vector<std::optional<Grid>> mesh_grid;  ///< [#meshes]; none: the mesh stays as it is.
  std::vector<std::optional<Grid>> skin_grid;  ///< [#skins]; to be folded into the inverse bind matrices.
  std::vector<Node> nodes;  ///< The model's, then one more for each shown mesh with a grid.
  /// [#nodes of the model]: the node that shows the mesh now (itself if nothing moved).
  std::vector<int> mesh_node;
};

/// Without `options.quantize` a plan that changes nothing.
///
/// A mesh without skin gets a grid of its own, and a child node that scales it back below each node that
/// shows it, so that animations and indices of the node stay right. Meshes that share skins share a grid,
/// which goes into the inverse bind matrices, and so do meshes that share vertices. Kept as floats, and told
/// to `context`: meshes shown both with and without skin, as instances (EXT_mesh_gpu_instancing), by no node,
/// by extensions, with points or lines, or with a material whose numbers are lengths in the mesh's space
/// (KHR_materials_volume).
QuantizationPlan plan_quantization(const Model& model, std::span<const int> vertices_of,
                                   const WriteOptions& options, Context& context);

/// Inverse bind matrices that take positions from the grid.
Accessor fold_grid(const Skin& skin, const Grid& grid);

}  // namespace fovea::gltf
