#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/model/model.h"

namespace fovea {

/// A number for each triangle of a mesh, [#F]; kInvalid for none.
using FaceNumbers = Field<FaceId, std::uint32_t>;

/// The model with a flat colour for each number as the only colours of its surface, as `heat_map` has them;
/// grey where there is no number. Borders are crisp: corners of a vertex differ where their triangles do.
/// `numbers` are [#meshes], each below the number of `colors`, which are display values. Throws Error(usage)
/// for numbers of another model. O(#F log #F).
Model face_map(const Model& model, const std::vector<FaceNumbers>& numbers,
               std::span<const std::array<std::uint8_t, 3>> colors);

/// The model with the numbers as one more attribute of its corners, −1 for none; `name` as in
/// `with_attribute`. Numbers from 2²⁴ on are rounded. Replaces one of that name. Throws as `face_map`.
/// O(#F log #F).
Model with_face_attribute(const Model& model, const std::vector<FaceNumbers>& numbers,
                          const std::string& name);

}  // namespace fovea
