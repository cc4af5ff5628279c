#include "fovea/texture/tangent_frame.h"

#include <cmath>

namespace fovea {

namespace {

constexpr std::array<std::size_t, 3> kCorners{0, 1, 2};

Vec3d mixed(const std::array<Vec3f, 3>& at, const std::array<double, 3>& weights) {
  return Vec3d(at[0]) * weights[0] + Vec3d(at[1]) * weights[1] + Vec3d(at[2]) * weights[2];
}

/// What is left of a direction across the normal, as a unit vector; any where nothing is.
Vec3d across(Vec3d direction, Vec3d normal) {
  const Vec3d rest = direction - normal * dot(normal, direction);
  if (length(rest) > 1e-6 * length(direction)) return normalized(rest);
  const Vec3d other = std::abs(normal.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  return normalized(other - normal * dot(normal, other));
}

Vec3f vector(const float* values) { return {values[0], values[1], values[2]}; }

}  // namespace

float turn(const TangentFrame& from, const TangentFrame& to) {
  return static_cast<float>(std::atan2(dot(to.tangent, from.bitangent), dot(to.tangent, from.tangent)));
}

Rgba turned(Rgba normal, float angle, bool is_mirrored) {
  if (angle == 0 && !is_mirrored) return normal;
  const float side = is_mirrored ? -0.5f : 0.5f;
  const float c = std::cos(angle), s = std::sin(angle), x = 2 * normal.r - 1, y = 2 * normal.g - 1;
  return {0.5f + 0.5f * (c * x + s * y), 0.5f + side * (c * y - s * x), normal.b, normal.a};
}

TangentFrames::TangentFrames(const Model& model, std::span<const AtlasFace> faces) : corners_(faces.size()) {
  add_normals(model, faces);
  add_tangents(model, faces);
}

void TangentFrames::add_normals(const Model& model, std::span<const AtlasFace> faces) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const TriMesh& mesh = model.meshes[faces[i].mesh].surface;
    const AttributeLayer* layer = mesh.find(Semantic::normal);
    const auto at = [&](std::size_t k) {
      return Vec3d(mesh.positions[mesh.triangles[faces[i].face][k].index()]);
    };
    Corners& corners = corners_[i];
    corners.face_normal = normalized(cross(at(1) - at(0), at(2) - at(0)));
    for (const std::size_t k : kCorners) {
      corners.normals[k] = Vec3f(corners.face_normal);
      if (layer == nullptr) continue;
      const ValueId id = layer->corner_value[std::size_t{3} * faces[i].face + k];
      if (id.valid()) corners.normals[k] = vector(layer->value(id));
    }
  }
}

void TangentFrames::add_tangents(const Model& model, std::span<const AtlasFace> faces) {
  std::vector<Vec3d> sums;  // of values, by area
  const auto own = [&](const AtlasFace& face) {
    const AttributeLayer* layer = model.meshes[face.mesh].surface.find(Semantic::tangent);
    return layer != nullptr && layer->corner_value[std::size_t{3} * face.face].valid() ? layer : nullptr;
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const AtlasFace& face = faces[i];
    const TriMesh& mesh = model.meshes[face.mesh].surface;
    const auto at = [&](std::size_t k) {
      return Vec3d(mesh.positions[mesh.triangles[face.face][k].index()]);
    };
    const Vec2d a = face.uv[1] - face.uv[0], b = face.uv[2] - face.uv[0];
    // v points down: with u to the right a triangle that is not mirrored has its corners clockwise.
    const double area = cross(a, b), sign = area < 0 ? -1 : area > 0 ? 1 : 0;
    corners_[i].side = area < 0 ? 1 : -1;
    const Vec3d along = normalized((at(1) - at(0)) * b.y - (at(2) - at(0)) * a.y) *
                        (sign * triangle_area(at(0), at(1), at(2)));
    for (const std::uint32_t value : face.value) {
      if (value >= sums.size()) sums.resize(value + std::size_t{1});
      sums[value] += along;
    }
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Corners& corners = corners_[i];
    const AttributeLayer* layer = own(faces[i]);
    for (const std::size_t k : kCorners) {
      corners.tangents[k] = Vec3f(normalized(sums[faces[i].value[k]]));
      if (layer == nullptr) continue;
      const ValueId id = layer->corner_value[std::size_t{3} * faces[i].face + k];
      if (id.valid()) corners.tangents[k] = vector(layer->value(id));
    }
    if (layer != nullptr && layer->width == 4)
      corners.side = layer->value(layer->corner_value[std::size_t{3} * faces[i].face])[3] < 0 ? -1 : 1;
  }
}

Vec3d TangentFrames::normal(std::uint32_t face, const std::array<double, 3>& weights) const {
  const Vec3d smooth = mixed(corners_[face].normals, weights);
  return length(smooth) > 1e-6 ? normalized(smooth) : corners_[face].face_normal;
}

TangentFrame TangentFrames::at(std::uint32_t face, const std::array<double, 3>& weights) const {
  TangentFrame frame;
  frame.normal = normal(face, weights);
  frame.tangent = across(mixed(corners_[face].tangents, weights), frame.normal);
  frame.bitangent = cross(frame.normal, frame.tangent) * corners_[face].side;
  return frame;
}

std::array<float, 4> TangentFrames::corner_tangent(std::uint32_t face, std::size_t corner) const {
  const Corners& c = corners_[face];
  const Vec3f t(across(Vec3d(c.tangents[corner]), normalized(Vec3d(c.normals[corner]))));
  return {t.x, t.y, t.z, static_cast<float>(c.side)};
}

std::vector<std::array<float, 3>> tangent_turns(const Model& model, std::span<const AtlasFace> from,
                                                std::span<const AtlasFace> to) {
  const TangentFrames before(model, from), after(model, to);
  std::vector<std::array<float, 3>> turns(from.size());
  for (std::uint32_t f = 0; f < turns.size(); ++f) {
    for (const std::size_t k : kCorners) {
      std::array<double, 3> weights{};
      weights[k] = 1;
      turns[f][k] = turn(before.at(f, weights), after.at(f, weights));
    }
  }
  return turns;
}

}  // namespace fovea
