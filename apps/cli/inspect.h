#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/model.h"
#include "fovea/surface/topology.h"

namespace fovea::cli {

/// A layer of a mesh as `info` shows it.
struct LayerFacts {
  std::string name;  ///< As files call it: "TEXCOORD_0".
  std::uint64_t values = 0;
  std::uint64_t seam_values = 0;  ///< Values beyond one per vertex: more than none means seams.
};

struct MeshFacts {
  EdgeCounts edges;
  std::uint64_t components = 0;
  std::uint64_t bow_ties = 0;
  std::uint64_t split_vertices = 0;
  std::uint64_t shown = 0;      ///< Instances in the scene.
  std::uint64_t raw_parts = 0;  ///< Parts made of points or lines.
  bool skinned = false;
  std::vector<LayerFacts> layers;
};

/// A texture that a material uses, in which role, and the image that it leads to (-1: none).
struct TextureUse {
  std::string role;  ///< "base color", ..., or "KHR_materials_sheen.sheenColorTexture".
  int texture = -1;
  int image = -1;
  int uv_set = 0;
};

/// What is worth knowing of a model beyond what it says itself.
struct ModelFacts {
  std::vector<MeshFacts> meshes;                  ///< [#meshes]
  std::vector<std::vector<TextureUse>> textures;  ///< [#materials]
  std::vector<ImageInfo> images;                  ///< [#images]
  std::vector<double> animation_seconds;          ///< [#animations], time of the last key.
  Box box;
  std::string generator;  ///< The program that made the file, if it says so.
};
ModelFacts inspect(const Model& model, Context& context);

/// The name of a layer's attribute in a glTF file: "NORMAL", "TEXCOORD_1", "_HEAT".
std::string attribute_name(const AttributeLayer& layer);

}  // namespace fovea::cli
