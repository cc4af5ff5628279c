#include "fovea/texture/surface_origin.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "fovea/surface/disjoint_sets.h"

namespace fovea {

namespace {

/// Of a triangle's longest edge: how far away the surface may be that it stands for.
constexpr double kReach = 0.5;
/// In texels: what comes from nearer stays where it is, as it was.
constexpr float kStill = 0.5f;
/// Of the image: how far apart places may be that triangles on one texel ask for.
constexpr float kAgreeing = 0.03f;
/// Stands for triangles on a texel that ask for different places.
constexpr std::uint8_t kDisagree = 255;

/// What must not be mixed up: materials, and the connected pieces of the original, so that what lies over
/// something else does not show it. Pieces are known if the simpler mesh tells where its vertices come from.
class Kinds {
 public:
  Kinds(const Model& original, const Model& simplified) {
    for (std::size_t m = 0; m < original.meshes.size(); ++m) {
      const TriMesh &from = original.meshes[m].surface, &to = simplified.meshes[m].surface;
      std::vector<std::uint32_t>& before = original_pieces_.emplace_back(from.vertex_count(), 0);
      std::vector<std::uint32_t>& after = pieces_.emplace_back(to.vertex_count(), 0);
      if (from.source_vertex.empty() || from.source_vertex.size() != to.source_vertex.size()) continue;
      DisjointSets sets(from.vertex_count());
      for (const auto& t : from.triangles) {
        sets.unite(t[0].index(), t[1].index());
        sets.unite(t[0].index(), t[2].index());
      }
      for (std::size_t v = 0; v < before.size(); ++v) before[v] = sets.find(v);
      for (std::size_t s = 0; s < from.source_vertex.size(); ++s) {
        const VertexId v = from.source_vertex[s], w = to.source_vertex[s];
        if (v.valid() && w.valid()) after[w.index()] = before[v.index()];
      }
    }
  }
  std::uint32_t of_original(const Model& model, const AtlasFace& face) {
    return kind(model, face, original_pieces_[face.mesh]);
  }
  std::uint32_t of_simplified(const Model& model, const AtlasFace& face) {
    return kind(model, face, pieces_[face.mesh]);
  }

 private:
  std::uint32_t kind(const Model& model, const AtlasFace& face, const std::vector<std::uint32_t>& pieces) {
    const TriMesh& mesh = model.meshes[face.mesh].surface;
    const std::pair key{pieces[mesh.triangles[face.face][0].index()],
                        mesh.parts[mesh.face_part[face.face]].material};
    return numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }

  std::vector<std::vector<std::uint32_t>> original_pieces_, pieces_;  // [#meshes][#V]
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> numbers_;
};

std::array<Vec3d, 3> points_of(const Model& model, const AtlasFace& face) {
  const TriMesh& mesh = model.meshes[face.mesh].surface;
  std::array<Vec3d, 3> points;
  for (std::size_t k = 0; k < 3; ++k) points[k] = Vec3d(mesh.positions[mesh.triangles[face.face][k].index()]);
  return points;
}

double longest_edge(const std::array<Vec3d, 3>& p) {
  return std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
}

bool are_mirrored(const TangentFrame& a, const TangentFrame& b) {
  const auto side = [](const TangentFrame& f) { return dot(cross(f.normal, f.tangent), f.bitangent); };
  return side(a) * side(b) < 0;
}

float distance(Vec2f a, Vec2f b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

SurfaceOrigin::SurfaceOrigin(const Model& original, const Atlas& original_atlas, const Model& simplified,
                             const Atlas& simplified_atlas)
    : original_faces_(atlas_faces(original, original_atlas)),
      faces_(atlas_faces(simplified, simplified_atlas)),
      original_frames_(original, original_faces_),
      frames_(simplified, faces_),
      targets_(original.meshes.size()) {
  Kinds kind(original, simplified);
  std::vector<std::vector<std::uint32_t>> kinds(targets_.size());
  for (std::uint32_t f = 0; f < original_faces_.size(); ++f) {
    const AtlasFace& face = original_faces_[f];
    const TriMesh& mesh = original.meshes[face.mesh].surface;
    Target& target = targets_[face.mesh];
    if (target.surface.positions.empty()) target.surface.positions = mesh.positions;
    const auto& t = mesh.triangles[face.face];
    target.surface.triangles.push_back({t[0].value, t[1].value, t[2].value});
    target.faces.push_back(f);
    kinds[face.mesh].push_back(kind.of_original(original, face));
  }
  for (std::size_t m = 0; m < targets_.size(); ++m) {
    if (!targets_[m].faces.empty())
      targets_[m].tree = std::make_unique<FacingPoint>(targets_[m].surface, std::move(kinds[m]));
  }
  for (const AtlasFace& face : faces_) {
    kinds_.push_back(kind.of_simplified(simplified, face));
    points_.push_back(points_of(simplified, face));
  }
}

std::optional<SurfaceOrigin::Place> SurfaceOrigin::place(std::uint32_t face,
                                                         const std::array<double, 3>& weights) const {
  const Target& target = targets_[faces_[face].mesh];
  if (target.tree == nullptr) return {};
  const std::array<Vec3d, 3>& p = points_[face];
  FacingPoint::Query query;
  query.point = p[0] * weights[0] + p[1] * weights[1] + p[2] * weights[2];
  query.normal = frames_.face_normal(face);
  query.most = kReach * longest_edge(p);
  query.kind = kinds_[face];
  if (!(query.most > 0) || !(length(query.normal) > 0)) return {};
  std::optional<ClosestPoint::Hit> hit = target.tree->along_normal(query);
  if (!hit) hit = target.tree->nearest(query);
  if (!hit) return {};
  return Place{target.faces[hit->triangle], hit->weights};
}

TexelOrigin SurfaceOrigin::origin(std::uint32_t face, const std::array<double, 3>& weights) const {
  const TangentFrame frame = frames_.at(face, weights);
  const std::optional<Place> found = place(face, weights);
  const Vec2d at = found ? uv_at(original_faces_[found->face], found->weights) : uv_at(faces_[face], weights);
  const TangentFrame from = found ? original_frames_.at(found->face, found->weights) : frame;
  return {{static_cast<float>(at.x), static_cast<float>(at.y)},
          face,
          turn(from, frame),
          are_mirrored(from, frame)};
}

TexelOrigins SurfaceOrigin::origins(int width, int height, const Context& context) const {
  TexelOrigins result{width, height, {}, {}};
  result.texels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  result.drawn.resize(result.texels.size(), 0);
  std::vector<std::uint8_t>& counts = result.drawn;
  const auto own = [&](std::uint32_t face, const std::array<double, 3>& weights) {
    const Vec2d uv = uv_at(faces_[face], weights);
    return Vec2f{static_cast<float>(uv.x), static_cast<float>(uv.y)};
  };
  const auto add = [&](std::uint32_t face, const std::array<double, 3>& weights, std::size_t texel) {
    std::uint8_t& count = counts[texel];
    if (count == kDisagree) return;
    const TexelOrigin next = origin(face, weights);
    TexelOrigin& mean = result.texels[texel];
    if (count == 0) mean = next;
    if (distance(mean.uv, next.uv) > kAgreeing || mean.is_mirrored != next.is_mirrored ||
        count + 1 == kDisagree) {
      count = kDisagree;
      mean.turn = 0;
      mean.is_mirrored = false;
      mean.uv = own(face, weights);
      return;
    }
    const float part = 1.0f / static_cast<float>(++count);
    mean.uv = mean.uv + (next.uv - mean.uv) * part;
    mean.turn += std::remainder(next.turn - mean.turn, 2 * std::numbers::pi_v<float>) * part;
  };
  for_atlas_texels(faces_, width, height, add, context);
  struct Nothing {};
  const AtlasRaster<Nothing> covered = rasterized<Nothing>(
      original_faces_, width, height, [](std::uint32_t, const std::array<double, 3>&) { return Nothing{}; },
      context);
  const auto is_covered = [&](Vec2f uv) {
    const auto texel = [](float x, int side) {
      return std::clamp(static_cast<int>(x * static_cast<float>(side)), 0, side - 1);
    };
    return covered.drawn[covered.index(texel(uv.x, width), texel(uv.y, height))] != 0;
  };
  const Vec2f size{static_cast<float>(width), static_cast<float>(height)};
  const auto settle = [&](std::uint32_t face, const std::array<double, 3>& weights, std::size_t texel) {
    TexelOrigin& origin = result.texels[texel];
    if (origin.face != face) return;
    const Vec2f at = own(face, weights), way = origin.uv - at;
    const bool is_still = std::hypot(way.x * size.x, way.y * size.y) < kStill;
    if (is_still) origin.uv = at;
    if (counts[texel] > 1 && !is_covered(origin.uv)) origin = {at, face};
  };
  for_atlas_texels(faces_, width, height, settle, context);
  const auto add_edge = [&](std::uint32_t face, const std::array<double, 3>& weights, std::size_t texel) {
    if (counts[texel] != 0) return;
    counts[texel] = 1;
    TexelOrigin& beside = result.texels[texel];
    beside = origin(face, weights);
    const Vec2f at = own(face, weights), way = beside.uv - at;
    if (std::hypot(way.x * size.x, way.y * size.y) >= kStill) return;
    // The texel's own centre, from a place that lies beside it.
    const auto x = static_cast<float>(texel % static_cast<std::size_t>(width)),
               y = static_cast<float>(texel / static_cast<std::size_t>(width));
    beside.uv = {(x + 0.5f) / size.x, (y + 0.5f) / size.y};
  };
  for_edge_texels(faces_, width, height, add_edge);
  for (std::uint8_t& count : counts) count = count != 0 ? 1 : 0;
  return result;
}

}  // namespace fovea
