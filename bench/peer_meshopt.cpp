#include <meshoptimizer.h>

#include <cfloat>
#include <memory>
#include <vector>

#include "fovea/model/weld.h"
#include "peers.h"

namespace fovea::bench {
namespace {

struct Buffers {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;
};

Buffers welded_buffers(const TriMesh& mesh) {
  Buffers buffers{mesh.positions, {}};
  buffers.indices.reserve(3 * mesh.face_count());
  for (const auto& triangle : mesh.triangles) {
    for (const VertexId v : triangle) buffers.indices.push_back(v.value);
  }
  return buffers;
}

std::vector<Buffers> buffers_of(const Model& model, bool welded) {
  std::vector<Buffers> result;
  for (const Mesh& mesh : model.meshes) {
    if (welded) {
      result.push_back(welded_buffers(mesh.surface));
      continue;
    }
    for (SplitPart& part : split(mesh.surface)) {
      result.push_back({std::move(part.positions), std::move(part.indices)});
    }
  }
  return result;
}

std::uint64_t simplify_buffers(const Buffers& buffers, double ratio) {
  if (buffers.indices.empty()) return 0;
  std::vector<std::uint32_t> result(buffers.indices.size());
  const auto target = static_cast<std::size_t>(static_cast<double>(buffers.indices.size()) * ratio) / 3 * 3;
  return meshopt_simplify(result.data(), buffers.indices.data(), buffers.indices.size(),
                          &buffers.positions[0].x, buffers.positions.size(), sizeof(Vec3f), target, FLT_MAX,
                          0, nullptr) /
         3;
}

}  // namespace

PeerWork meshopt_peer(const Model& model, double ratio, bool welded) {
  auto all = std::make_shared<const std::vector<Buffers>>(buffers_of(model, welded));
  return [all, ratio] {
    std::uint64_t triangles = 0;
    for (const Buffers& buffers : *all) triangles += simplify_buffers(buffers, ratio);
    return triangles;
  };
}

}  // namespace fovea::bench
