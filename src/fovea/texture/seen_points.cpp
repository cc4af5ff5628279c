#include "fovea/texture/seen_points.h"

#include <cmath>
#include <numeric>

#include "fovea/base/srgb.h"
#include "fovea/texture/texel_origin.h"

namespace fovea {

namespace {

/// Of the angle between a surface and who looks: that of a sphere, by what of it shows.
constexpr double kMeanCosine = 2.0 / 3;
/// How points go on inside triangles: as the sequence R2, by the powers of 1/g, g the plastic number.
constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;

}  // namespace

std::vector<double> surface_areas(const Model& model, std::span<const AtlasFace> faces) {
  const std::vector<double> scales = largest_scales(model);
  std::vector<double> areas;
  areas.reserve(faces.size());
  for (const AtlasFace& face : faces) {
    const TriMesh& mesh = model.meshes[face.mesh].surface;
    const auto at = [&](std::size_t k) {
      return Vec3d(mesh.positions[mesh.triangles[face.face][k].index()]);
    };
    areas.push_back(triangle_area(at(0), at(1), at(2)) * scales[face.mesh] * scales[face.mesh]);
  }
  return areas;
}

std::vector<SurfacePoint> spread_points(const Model& model, std::span<const AtlasFace> faces,
                                        std::span<const VertexField> field, std::size_t count) {
  std::vector<double> ends = surface_areas(model, faces);
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  const double area = ends.empty() ? 0 : ends.back();
  std::vector<SurfacePoint> points;
  if (!(area > 0)) return points;
  std::uint32_t face = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double along = area * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    while (face + std::size_t{1} < ends.size() && ends[face] < along) ++face;
    // Evenly over a triangle, wherever in it the sum of areas ends.
    const double root = std::sqrt(std::fmod(0.5 + static_cast<double>(i) * kStepX, 1.0)),
                 across = std::fmod(0.5 + static_cast<double>(i) * kStepY, 1.0);
    SurfacePoint point{face, {1 - root, root * (1 - across), root * across}, 1};
    if (!field.empty()) {
      const auto& triangle = model.meshes[faces[face].mesh].surface.triangles[faces[face].face];
      point.counts = 0;
      for (std::size_t k = 0; k < 3; ++k)
        point.counts += point.weights[k] * static_cast<double>(field[faces[face].mesh][triangle[k]]);
    }
    points.push_back(point);
  }
  return points;
}

std::vector<UvSlopes> picture_slopes(const Model& model, std::span<const AtlasFace> faces) {
  const std::vector<double> scales = largest_scales(model);
  const Box box = bounds(model);
  const double pixel = length(Vec3d(box.high) - Vec3d(box.low)) / kMeanCosine;
  std::vector<UvSlopes> result(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const AtlasFace& face = faces[i];
    const TriMesh& mesh = model.meshes[face.mesh].surface;
    const auto at = [&](std::size_t k) {
      return Vec3d(mesh.positions[mesh.triangles[face.face][k].index()]) * scales[face.mesh];
    };
    // The first side lies along x, so the second is (along, up).
    const Vec3d first = at(1) - at(0), second = at(2) - at(0);
    const double side = length(first), area = length(cross(first, second));
    if (!(area > 0)) continue;
    const double along = dot(first, second) / side, up = area / side;
    const Vec2d x = (face.uv[1] - face.uv[0]) * (1 / side),
                y = (face.uv[2] - face.uv[0] - x * along) * (1 / up);
    result[i] = {single(x * pixel), single(y * pixel)};
  }
  return result;
}

double loss_weight(const TexelMeaning& meaning) {
  switch (meaning.kind) {
    case TexelMeaning::Kind::color: return 1;
    case TexelMeaning::Kind::normal: return 0.5;
    case TexelMeaning::Kind::data: break;
  }
  return 0.25;
}

Rgba shown(Rgba value, const TexelMeaning& meaning) {
  if (!meaning.transparent) value.a = 1;
  if (meaning.kind != TexelMeaning::Kind::color) return value;
  const auto displayed = [](float light) { return static_cast<float>(to_display(light)) / 255; };
  return {displayed(value.r), displayed(value.g), displayed(value.b), value.a};
}

}  // namespace fovea
