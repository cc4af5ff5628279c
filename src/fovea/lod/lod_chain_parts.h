#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "fovea/model/model.h"

// Private to lod.

namespace fovea {

/// Puts the images, textures, materials and meshes of levels beside those of the original.
class LodParts {
 public:
  /// Begins with all of the original; refers to `all`, to which it appends.
  explicit LodParts(Model& all) : all_(all) {}

  /// [#meshes of the level] The index of each mesh of a level. Levels come from the finest to the coarsest.
  std::vector<int> add(const Model& level, int number);

 private:
  std::vector<int> add_images(const Model& level);
  std::vector<int> add_textures(const Model& level, const std::vector<int>& image);
  std::vector<int> add_materials(const Model& level, const std::vector<int>& texture);
  int add_mesh(const Mesh& mesh, int before, const std::vector<int>& material, int number);

  Model& all_;
  std::vector<int> before_;               // [#meshes] of the level before; empty for the original
  std::map<std::size_t, int> last_copy_;  // of a material with other textures
};

}  // namespace fovea
