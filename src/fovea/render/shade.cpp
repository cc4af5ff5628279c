#include "fovea/render/shade.h"

#include <algorithm>
#include <cmath>

#include "fovea/render/light_rig.h"

namespace fovea {

namespace {

constexpr std::size_t kCorners = 3;

Vec3f mix(const SurfacePoint& p, Vec3f a, Vec3f b, Vec3f c) {
  return a * p.weight[0] + b * p.weight[1] + c * p.weight[2];
}

/// The values of a layer at the corners of a face; null if the face has none.
std::array<const float*, 3> corner_values(const AttributeLayer* layer, FaceId face) {
  std::array<const float*, 3> values{};
  if (layer == nullptr) return values;
  for (int k = 0; k < 3; ++k) {
    const ValueId id = layer->corner_value[corner(face, k).index()];
    if (!id.valid()) return {};
    values[static_cast<std::size_t>(k)] = layer->value(id);
  }
  return values;
}

Vec2f mix_uv(const std::array<float, 3>& weights, const std::array<const float*, 3>& uv) {
  Vec2f sum;
  for (std::size_t k = 0; k < kCorners; ++k) sum = sum + Vec2f{uv[k][0], uv[k][1]} * weights[k];
  return sum;
}

}  // namespace

TriangleShader::TriangleShader(const RenderScene& scene, const Projection& projection, int anisotropy,
                               std::uint32_t triangle)
    : scene_(scene), projection_(projection), anisotropy_(anisotropy), triangle_(triangle) {
  const TriangleOrigin from = origin(scene, triangle);
  mesh_ = &scene.meshes[from.mesh];
  mesh_number_ = from.mesh;
  face_ = from.face;
  material_ = &scene.materials[mesh_->part_material[mesh_->mesh->face_part[face_.index()]]];
  std::array<Vec3d, 3> h;
  for (std::size_t k = 0; k < kCorners; ++k) {
    positions_[k] = mesh_->surface.positions[mesh_->mesh->triangles[face_.index()][k].index()];
    h[k] = projection.view().to_eye(Vec3d(positions_[k]));
    if (!projection.view().perspective) h[k].z = 1;
  }
  for (std::size_t k = 0; k < kCorners; ++k) edges_[k] = cross(h[(k + 1) % 3], h[(k + 2) % 3]);
  sum_ = edges_[0] + edges_[1] + edges_[2];
  const Vec3d p0(positions_[0]);
  face_normal_ = Vec3f(normalized(cross(Vec3d(positions_[1]) - p0, Vec3d(positions_[2]) - p0)) *
                       (mesh_->surface.mirrored ? -1.0 : 1.0));
  uv_0_ = uv_of_set(0);
}

SurfacePoint TriangleShader::at(double x, double y) const {
  const Vec2d plane = projection_.to_plane(x, y);
  const Vec3d d{plane.x, plane.y, 1};
  const double total = dot(sum_, d), inverse = total != 0 ? 1 / total : 0;
  const double pixel = projection_.pixel() * inverse;
  SurfacePoint point;
  for (std::size_t k = 0; k < kCorners; ++k) {
    const double weight = dot(edges_[k], d) * inverse;
    point.weight[k] = static_cast<float>(weight);
    point.dx[k] = static_cast<float>((edges_[k].x - weight * sum_.x) * pixel);
    point.dy[k] = static_cast<float>((weight * sum_.y - edges_[k].y) * pixel);
  }
  return point;
}

std::array<const float*, 3> TriangleShader::uv_of_set(int set) const {
  const auto& layers = mesh_->uv;
  return corner_values(
      static_cast<std::size_t>(set) < layers.size() ? layers[static_cast<std::size_t>(set)] : nullptr, face_);
}

Rgba TriangleShader::look_up(const SceneTexture& texture, const SurfacePoint& point, LastLook& last) const {
  const MipMap& map = *scene_.images[static_cast<std::size_t>(texture.image)].map;
  if (last.look != texture.look) {
    const auto corners = uv(texture.uv_set);
    if (corners[0] == nullptr) return {1, 1, 1, 1};
    const Vec2f at = texture.matrix(mix_uv(point.weight, corners));
    const UvSlopes slopes{texture.matrix.direction(mix_uv(point.dx, corners)),
                          texture.matrix.direction(mix_uv(point.dy, corners))};
    last.footprint = map.footprint(at, slopes, texture.sampler, anisotropy_);
    last.look = texture.look;
  }
  return map.sample(last.footprint);
}

Rgba TriangleShader::base_color(const SurfacePoint& point, LastLook& last) const {
  Rgba color = material_->base_color;
  if (material_->base_color_texture) color = color * look_up(*material_->base_color_texture, point, last);
  const auto values = corner_values(mesh_->color, face_);
  if (values[0] != nullptr) {
    const bool has_alpha = mesh_->color->width > 3;
    Rgba vertex{0, 0, 0, has_alpha ? 0.0f : 1.0f};
    for (std::size_t k = 0; k < kCorners; ++k) {
      vertex = vertex + Rgba{values[k][0], values[k][1], values[k][2], has_alpha ? values[k][3] : 0.0f} *
                            point.weight[k];
    }
    color = color * vertex;
  }
  if (material_->alpha_mode == AlphaMode::opaque) color.a = 1;
  color.a = std::clamp(color.a, 0.0f, 1.0f);
  return color;
}

Vec3f TriangleShader::to_eye(const SurfacePoint& point) const {
  if (!projection_.view().perspective) return Vec3f(projection_.view().back);
  return Vec3f(
      normalized(projection_.view().eye - Vec3d(mix(point, positions_[0], positions_[1], positions_[2]))));
}

/// Bends a normal by the material's normal map. Without tangents of its own a triangle has those along which
/// its texture coordinates run, or none if it has no area there.
Vec3f TriangleShader::map_normal(Vec3f normal, const SurfacePoint& point, LastLook& last) const {
  const SceneTexture& texture = *material_->normal_texture;
  const auto corners = uv(texture.uv_set);
  if (corners[0] == nullptr) return normal;
  const AttributeLayer* const layer = mesh_->tangent;
  const auto signs = corner_values(layer, face_);
  Vec3f tangent;
  float side = 1;
  if (signs[0] != nullptr) {
    std::array<Vec3f, 3> t;
    for (int k = 0; k < 3; ++k) {
      t[static_cast<std::size_t>(k)] =
          mesh_->surface.tangents[layer->corner_value[corner(face_, k).index()].index()];
    }
    tangent = mix(point, t[0], t[1], t[2]);
    side = signs[0][3] < 0 ? -1.0f : 1.0f;
    if (mesh_->surface.mirrored) side = -side;
  } else {
    const auto corner_uv = [&](std::size_t k) { return Vec2f{corners[k][0], corners[k][1]}; };
    const Vec2f a = texture.matrix.direction(corner_uv(1) - corner_uv(0)),
                b = texture.matrix.direction(corner_uv(2) - corner_uv(0));
    const float area = cross(a, b);
    if (area == 0) return normal;
    const Vec3f ea = positions_[1] - positions_[0], eb = positions_[2] - positions_[0];
    tangent = (ea * b.y - eb * a.y) * (area < 0 ? -1.0f : 1.0f);
    // v points down, green points up: with u to the right that is a right-handed frame.
    side = (area < 0) == mesh_->surface.mirrored ? -1.0f : 1.0f;
  }
  tangent = tangent - normal * dot(normal, tangent);
  const float l = length(tangent);
  if (!(l > 0)) return normal;
  tangent = tangent / l;
  const Vec3f bitangent = cross(normal, tangent) * side;
  const Rgba texel = look_up(texture, point, last);
  const float x = (2 * texel.r - 1) * material_->normal_scale,
              y = (2 * texel.g - 1) * material_->normal_scale, z = 2 * texel.b - 1;
  const Vec3f bent = tangent * x + bitangent * y + normal * z;
  return length(bent) > 0 ? normalized(bent) : normal;
}

Vec3f TriangleShader::geometric_normal(const SurfacePoint& point) const {
  if (corner_values(mesh_->normal, face_)[0] == nullptr) return face_normal_;
  std::array<Vec3f, 3> at;
  for (int k = 0; k < 3; ++k) {
    at[static_cast<std::size_t>(k)] =
        mesh_->surface.normals[mesh_->normal->corner_value[corner(face_, k).index()].index()];
  }
  const Vec3f smooth = mix(point, at[0], at[1], at[2]);
  const float l = length(smooth);
  return l > 1e-6f ? smooth / l : face_normal_;
}

Vec3f TriangleShader::normal(const SurfacePoint& point, LastLook& last) const {
  Vec3f n = geometric_normal(point);
  if (material_->normal_texture) n = map_normal(n, point, last);
  return toward(n, to_eye(point));
}

Rgba TriangleShader::lit(const SurfacePoint& point, LastLook& last) const {
  const Rgba color = base_color(point, last);
  if (material_->unlit) return color;
  SurfaceLook look;
  look.base_color = color;
  look.metallic = material_->metallic;
  look.roughness = material_->roughness;
  if (material_->metallic_roughness_texture) {
    const Rgba texel = look_up(*material_->metallic_roughness_texture, point, last);
    look.roughness *= texel.g;
    look.metallic *= texel.b;
  }
  if (material_->occlusion_texture) {
    const float seen = look_up(*material_->occlusion_texture, point, last).r;
    look.occlusion = 1 + material_->occlusion_strength * (seen - 1);
  }
  look.emission = material_->emission;
  if (material_->emissive_texture)
    look.emission = look.emission * look_up(*material_->emissive_texture, point, last);
  Vec3f n = geometric_normal(point);
  if (material_->normal_texture) n = map_normal(n, point, last);
  const Vec3f v = to_eye(point);
  return light_to_eye(look, toward(n, v), v);
}

float TriangleShader::depth(const SurfacePoint& point) const {
  const View& view = projection_.view();
  const double distance = view.to_eye(Vec3d(mix(point, positions_[0], positions_[1], positions_[2]))).z;
  const double middle = view.to_eye(scene_.sphere.center).z, radius = scene_.sphere.radius;
  const double depth = radius > 0 ? 0.5 - 0.5 * (distance - middle) / radius : 0.5;
  return static_cast<float>(std::clamp(depth, 0.0, 1.0));
}

float TriangleShader::field(const SurfacePoint& point, std::span<const float> per_vertex) const {
  float sum = 0;
  for (std::size_t k = 0; k < kCorners; ++k)
    sum += per_vertex[mesh_->mesh->triangles[face_.index()][k].index()] * point.weight[k];
  return sum;
}

std::uint32_t TriangleShader::region(const SurfacePoint& point, std::span<const float> per_vertex) const {
  const auto most = std::max_element(point.weight.begin(), point.weight.end()) - point.weight.begin();
  const VertexId v = mesh_->mesh->triangles[face_.index()][static_cast<std::size_t>(most)];
  const float number = per_vertex[v.index()];
  return number >= 0 && number < 0x1p31f ? static_cast<std::uint32_t>(number + 0.5f) : kInvalid;
}

}  // namespace fovea
