#include "fovea/simplify/shown_surface.h"

#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/surface/pose.h"

namespace fovea {

namespace {

Mat4 mixed(const Mat4& a, const Mat4& b, double along) {
  Mat4 m;
  for (std::size_t i = 0; i < m.m.size(); ++i) m.m[i] = a.m[i] + (b.m[i] - a.m[i]) * along;
  return m;
}

}  // namespace

ShownSurface::ShownSurface(const CollapseState& state, const Model& model,
                           std::span<const std::size_t> mesh_index, const RenderScene& scene,
                           const Pose& pose, std::vector<View> views, int size, const Context& context)
    : state_(state), materials_(scene.materials) {
  for (const View& view : views)
    projections_.emplace_back(view, SampleGrid{picture_width(view, size), size, 1});
  const std::vector<Instance> instances_shown = instances(model, pose);
  std::uint64_t vertices = 0, faces = 0;
  for (std::uint32_t s = 0; s < state.slots.size(); ++s) {
    const TriMesh& mesh = model.meshes[mesh_index[s]].surface;
    first_showing_.push_back(static_cast<std::uint32_t>(showings_.size()));
    for (std::size_t i = 0; i < instances_shown.size(); ++i) {
      if (instances_shown[i].mesh != mesh_index[s]) continue;
      ShownInstance showing{s,
                            static_cast<std::uint32_t>(vertices),
                            static_cast<std::uint32_t>(faces),
                            scene.meshes[i].surface.mirrored,
                            instances_shown[i].world,
                            {}};
      const std::vector<Mat4> bent = vertex_transforms(model, pose, instances_shown[i]);
      for (std::size_t v = 0; v < bent.size(); ++v)
        showing.bent.push_back(bent[state.mesh_vertex[state.slots[s].first_vertex + v].index()]);
      showings_.push_back(std::move(showing));
      vertices += mesh.vertex_count();
      faces += state.face_count(s);
    }
    for (std::size_t f = 0; f < state.face_count(s); ++f) {
      const FaceId id = state.mesh_face[state.slots[s].first_face + f];
      face_part_.push_back(mesh.face_part[id.index()]);
      const int material = mesh.parts[face_part_.back()].material;
      face_material_.push_back(
          static_cast<std::uint32_t>(material >= 0 ? material : static_cast<int>(materials_.size()) - 1));
    }
  }
  first_showing_.push_back(static_cast<std::uint32_t>(showings_.size()));
  if (faces >= kInvalid || vertices >= kInvalid)
    throw Error(ErrorKind::limit, "more triangles are shown than views can look at", "simplify");
  face_count_ = static_cast<std::uint32_t>(faces);

  screen_.resize(vertices * view_count());
  for (const ShownInstance& showing : showings_) {
    const std::uint32_t first = state.slots[showing.slot].first_vertex;
    const std::size_t count = model.meshes[mesh_index[showing.slot]].surface.vertex_count();
    parallel_for(context, count, 1 << 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t v = first + static_cast<std::uint32_t>(i);
        project(showing, state.mesh.position(v), to_world(showing, v),
                screen_.data() + row(showing, v) * view_count());
      }
    });
  }
}

Mat4 ShownSurface::to_world(const ShownInstance& showing, std::uint32_t a, std::uint32_t b,
                            double along) const {
  if (showing.bent.empty()) return showing.world;
  return mixed(to_world(showing, a), to_world(showing, b), along);
}

void ShownSurface::project(const ShownInstance& showing, Vec3d p, const Mat4& world,
                           ScreenVertex* out) const {
  const Vec3d at = transform_point(world, state_.slots[showing.slot].to_local_exact(p));
  for (std::size_t view = 0; view < view_count(); ++view) {
    const Projection& projection = projections_[view];
    if (!projection.project(projection.view().to_eye(at), out[view])) out[view].x = kUnplaced;
  }
}

void ShownSurface::move(std::uint32_t v, std::uint32_t a, std::uint32_t b, Vec3d p, double along) {
  const std::uint32_t slot = state_.slot_of_vertex(v);
  for (std::size_t i = first_showing_[slot]; i < first_showing_[slot + 1]; ++i) {
    ShownInstance& showing = showings_[i];
    const Mat4 world = to_world(showing, a, b, along);
    if (!showing.bent.empty()) showing.bent[v - state_.slots[slot].first_vertex] = world;
    project(showing, p, world, screen_.data() + row(showing, v) * view_count());
  }
}

}  // namespace fovea
