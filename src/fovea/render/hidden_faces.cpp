#include "fovea/render/hidden_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/model/texture_use.h"
#include "fovea/render/scene.h"
#include "fovea/surface/key_poses.h"
#include "fovea/surface/occlusion.h"
#include "fovea/surface/pose.h"

namespace fovea {

namespace {

constexpr int kMoreEyes = 256;
/// Steps between samples on a face, in a scene's radius.
constexpr double kSamplesPerRadius = 128;
/// How far from a face lines of sight begin, of the scene's radius: farther than rounding moves it.
constexpr double kLift = 1e-5;
/// Samples at corners lie this far inside, of the way to the face's middle.
constexpr double kInset = 0.05;

/// Where a triangle of the posed scene comes from.
struct ShownFace {
  std::uint32_t mesh;
  FaceId face;
  bool double_sided;
};

/// What a pose shows: all triangles, front sides counter-clockwise, and those alone that hide others.
struct PosedFaces {
  Surface all, blockers;
  std::vector<ShownFace> faces;          // [#F of all]
  std::vector<bool> double_sided_block;  // [#F of blockers]
};

bool blocks_sight(const Material& material) {
  return material.alpha_mode == AlphaMode::opaque &&
         material.json.find("KHR_materials_transmission") == std::string::npos;
}

PosedFaces posed_faces(const Model& model, const Pose& pose) {
  PosedFaces posed;
  for (const Instance& instance : instances(model, pose)) {
    const TriMesh& mesh = model.meshes[instance.mesh].surface;
    const PosedSurface shape = posed_surface(model, pose, instance);
    const std::size_t first = posed.all.triangles.size();
    append(posed.all, mesh, shape.positions, shape.mirrored);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const Material& material = material_of(model, mesh.parts[mesh.face_part[f]]);
      posed.faces.push_back({static_cast<std::uint32_t>(instance.mesh), FaceId{f}, material.double_sided});
      if (!blocks_sight(material)) continue;
      posed.blockers.triangles.push_back(posed.all.triangles[first + f]);
      posed.double_sided_block.push_back(material.double_sided);
    }
  }
  posed.blockers.positions = posed.all.positions;
  return posed;
}

/// Around the box of its points.
Sphere sphere_around(const Surface& surface) {
  Box box;
  for (const Vec3f& p : surface.positions) box.add(Vec3d(p));
  return {box.center(), 0.5 * box.diagonal()};
}

/// Eyes in parallel projection are far away.
std::vector<Vec3d> eyes_of(const ViewOptions& options, const Model& model, const Pose& pose,
                           const Sphere& sphere) {
  std::vector<View> views = views_of(options, model, pose, sphere);
  if (options.set != ViewSet::cameras) {
    ViewOptions more = options;
    more.set = ViewSet::fibonacci;
    more.count = kMoreEyes;
    const std::vector<View> others = make_views(more, sphere);
    views.insert(views.end(), others.begin(), others.end());
  }
  std::vector<Vec3d> eyes;
  for (const View& view : views)
    eyes.push_back(view.perspective ? view.eye : sphere.center + view.back * (1e3 * sphere.radius));
  return eyes;
}

/// Looks for a free line from faces to eyes.
class Sight {
 public:
  Sight(const PosedFaces& posed, std::vector<Vec3d> eyes, double radius)
      : posed_(posed),
        eyes_(std::move(eyes)),
        radius_(radius),
        occlusion_(posed.blockers, posed.double_sided_block) {}

  bool sees(std::size_t f) const {
    if (!(radius_ > 0)) return true;  // shown as a point
    const auto& t = posed_.all.triangles[f];
    const std::array<Vec3d, 3> p{posed_.all.position(t[0]), posed_.all.position(t[1]),
                                 posed_.all.position(t[2])};
    const Vec3d normal = normalized(cross(p[1] - p[0], p[2] - p[0]));
    const Vec3d middle = (p[0] + p[1] + p[2]) / 3;
    if (is_free(middle, normal, f)) return true;
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    const int steps = std::max(1, static_cast<int>(std::ceil(longest * kSamplesPerRadius / radius_)));
    for (int i = 0; i <= steps; ++i) {
      for (int k = 0; i + k <= steps; ++k) {
        const double u = static_cast<double>(i) / steps, v = static_cast<double>(k) / steps;
        const Vec3d q = p[0] + (p[1] - p[0]) * u + (p[2] - p[0]) * v;
        if (is_free(q + (middle - q) * kInset, normal, f)) return true;
      }
    }
    return false;
  }

 private:
  bool is_free(Vec3d p, Vec3d normal, std::size_t f) const {
    for (const Vec3d& eye : eyes_) {
      const double side = dot(eye - p, normal);
      if (side <= 0 && !posed_.faces[f].double_sided) continue;
      if (!occlusion_.hides(p + normal * (side < 0 ? -kLift * radius_ : kLift * radius_), eye)) return true;
    }
    return false;
  }

  const PosedFaces& posed_;
  const std::vector<Vec3d> eyes_;
  const double radius_;
  const Occlusion occlusion_;
};

/// Marks the faces that are seen in a pose, or that are shown at all.
void look(const Model& model, const Pose& pose, const ViewOptions& views, const Context& context,
          std::vector<std::vector<std::uint8_t>>& seen, std::vector<bool>& shown) {
  const PosedFaces posed = posed_faces(model, pose);
  const Sphere sphere = sphere_around(posed.all);
  const Sight sight(posed, eyes_of(views, model, pose, sphere), sphere.radius);
  const auto known = [&](const ShownFace& face) -> std::uint8_t& {
    return seen[face.mesh][face.face.index()];
  };
  std::vector<std::uint8_t> found(posed.faces.size(), 0);
  parallel_for_or_throw(context, posed.faces.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) found[f] = known(posed.faces[f]) != 0 || sight.sees(f);
  });
  for (std::size_t f = 0; f < posed.faces.size(); ++f) {
    shown[posed.faces[f].mesh] = true;
    if (found[f] != 0) known(posed.faces[f]) = 1;
  }
}

}  // namespace

std::vector<std::vector<FaceId>> hidden_faces(const Model& model, const ViewOptions& views,
                                              const Context& context) {
  std::vector<std::vector<std::uint8_t>> seen;
  for (const Mesh& mesh : model.meshes) seen.emplace_back(mesh.surface.face_count(), 0);
  std::vector<bool> shown(model.meshes.size(), false);
  const Pose rest = rest_pose(model);
  look(model, rest, views, context, seen, shown);
  for (const KeyPose& key : key_poses(model, {}, context)) {
    if (key.pose != rest) look(model, key.pose, views, context, seen, shown);
  }
  std::vector<std::vector<FaceId>> hidden(model.meshes.size());
  for (std::size_t m = 0; m < hidden.size(); ++m) {
    if (!shown[m]) continue;
    for (std::size_t f = 0; f < seen[m].size(); ++f) {
      if (seen[m][f] == 0) hidden[m].push_back(FaceId{f});
    }
  }
  return hidden;
}

}  // namespace fovea
