#pragma once

#include <set>
#include <vector>

#include "fovea/model/model.h"
#include "fovea/texture/resize.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// One of the ways in which a material reads an image.
struct TextureRead {
  int image = -1;  ///< Index into the model's images.
  TexelMeaning meaning;
  bool alpha_counts =
      false;  ///< Its alpha may be read: alpha masks and blending, and all that extensions do.
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  int uv_set = 0;
  bool is_transformed = false;  ///< KHR_texture_transform moves its coordinates,
  UvMatrixd matrix;             ///< by this.
};

/// All reads of a material that lead to an image: those of the core's roles, then those of extensions, which
/// are the objects whose names end in "Texture": normal maps if that is in the name, colours for those that
/// Khronos' extensions define in sRGB (sheen, specular, diffuse and diffuse transmission), else data.
std::vector<TextureRead> texture_reads(const Model& model, const Material& material);

/// The materials that a part can have: its own (-1 if it has none) and those of its variants
/// (KHR_materials_variants). Rising.
std::set<int> part_materials(const Model& model, const Part& part);

}  // namespace fovea
