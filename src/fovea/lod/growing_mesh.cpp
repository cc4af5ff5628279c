#include "fovea/lod/growing_mesh.h"

#include <algorithm>
#include <utility>

namespace fovea {

VertexId GrowingMesh::add_vertex() {
  surface.positions.emplace_back();
  for (auto& morph : surface.position_morphs) morph.emplace_back();
  fans_.emplace_back();
  return VertexId{surface.positions.size() - 1};
}

ValueId GrowingMesh::add_value(std::size_t layer) {
  AttributeLayer& l = surface.layers[layer];
  const ValueId id{l.size()};
  const auto width = static_cast<std::size_t>(l.width);
  l.values.resize(l.values.size() + width);
  for (std::size_t t = 0; t < l.morphs.size(); ++t) {
    if (morphed[layer][t]) l.morphs[t].resize(l.values.size());
  }
  return id;
}

FaceId GrowingMesh::add_face(std::array<VertexId, 3> corners, std::uint32_t part,
                             std::span<const ValueId> values) {
  const auto f = static_cast<std::uint32_t>(surface.triangles.size());
  surface.triangles.push_back(corners);
  surface.face_part.push_back(part);
  for (std::uint32_t k = 0; k < 3; ++k) fans_[corners[k].index()].push_back(3 * f + k);
  for (std::size_t l = 0; l < surface.layers.size(); ++l) {
    auto& list = surface.layers[l].corner_value;
    list.insert(list.end(), values.begin() + static_cast<std::ptrdiff_t>(3 * l),
                values.begin() + static_cast<std::ptrdiff_t>(3 * l + 3));
  }
  return FaceId{f};
}

void GrowingMesh::split_fan(VertexId from, VertexId to, std::span<const std::uint8_t> side) {
  std::vector<std::uint32_t>& old = fans_[from.index()];
  std::vector<std::uint32_t>& other = fans_[to.index()];
  std::size_t left = 0;
  for (std::size_t i = 0; i < old.size(); ++i) {
    const std::uint32_t c = old[i];
    if (side[i] != 0) {
      other.push_back(c);
      surface.triangles[c / 3][c % 3] = to;
    } else {
      old[left++] = c;
    }
  }
  old.resize(left);
}

void GrowingMesh::neighbors(VertexId v, std::uint32_t stamp, std::vector<std::uint32_t>& seen,
                            std::vector<VertexId>& out) const {
  out.clear();
  if (seen.size() < surface.vertex_count()) seen.resize(surface.vertex_count());
  for (const std::uint32_t c : fan(v)) {
    const auto& t = surface.triangles[c / 3];
    for (const VertexId w : {t[(c % 3 + 1) % 3], t[(c % 3 + 2) % 3]}) {
      if (std::exchange(seen[w.index()], stamp) != stamp) out.push_back(w);
    }
  }
}

void GrowingMesh::values_at(VertexId v, std::size_t layer, std::vector<ValueId>& out) const {
  out.clear();
  const auto& values = surface.layers[layer].corner_value;
  for (const std::uint32_t c : fan(v)) {
    if (values[c].valid() && std::find(out.begin(), out.end(), values[c]) == out.end())
      out.push_back(values[c]);
  }
}

std::uint32_t GrowingMesh::corner_beside(VertexId v, VertexId w, std::uint32_t after) const {
  for (const std::uint32_t c : fan(v)) {
    if (surface.triangles[c / 3][(c % 3 + after) % 3] == w) return c;
  }
  return kInvalid;
}

}  // namespace fovea
