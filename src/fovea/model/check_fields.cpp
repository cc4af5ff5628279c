#include "fovea/model/check_fields.h"

#include <fmt/format.h>

#include "fovea/base/error.h"

namespace fovea {

void check_fields(const Model& model, std::span<const VertexField> fields) {
  if (fields.size() != model.meshes.size()) {
    throw Error(ErrorKind::usage, fmt::format("there are {} fields but the model has {} meshes",
                                              fields.size(), model.meshes.size()));
  }
  for (std::size_t m = 0; m < fields.size(); ++m) {
    const std::size_t count = model.meshes[m].surface.vertex_count();
    if (fields[m].size() == count) continue;
    throw Error(ErrorKind::usage,
                fmt::format("the field of mesh {} has {} values but the mesh has {} vertices", m,
                            fields[m].size(), count));
  }
}

}  // namespace fovea
