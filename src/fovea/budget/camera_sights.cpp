#include "fovea/budget/camera_sights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/budget/seen_detail.h"
#include "fovea/budget/wavelet.h"
#include "fovea/render/render.h"

namespace fovea {

namespace {

constexpr double kMostLooks = 1 << 15;
/// Of a step of a byte: what is left of an image is hardly changed.
constexpr float kFineStep = 0.25f;
/// Waves of two pixels and longer are shown.
constexpr double kOctaves = 0;

/// The triangles of an atlas by their meshes.
class AtlasLook {
 public:
  AtlasLook(const Model& model, const Atlas& atlas)
      : faces_(atlas_faces(model, atlas)), at_(model.meshes.size()) {
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      std::vector<std::uint32_t>& mesh = at_[faces_[i].mesh];
      if (mesh.empty()) mesh.assign(model.meshes[faces_[i].mesh].surface.face_count(), kInvalid);
      mesh[faces_[i].face] = static_cast<std::uint32_t>(i);
    }
  }
  const AtlasFace* find(std::uint32_t mesh, FaceId face) const {
    if (at_[mesh].empty() || at_[mesh][face.index()] == kInvalid) return nullptr;
    return &faces_[at_[mesh][face.index()]];
  }

 private:
  std::vector<AtlasFace> faces_;
  std::vector<std::vector<std::uint32_t>> at_;  // [#meshes][#F], into the faces; empty without any
};

/// A triangle of the scene with its texture coordinates, as a picture shows its plane.
class ShownPlane {
 public:
  ShownPlane(const View& view, int size, const std::array<Vec3d, 3>& corners, const AtlasFace& face)
      : view_(view),
        to_plane_(2 * view.half_height / size),
        half_width_(0.5 * picture_width(view, size)),
        half_height_(0.5 * size),
        origin_(corners[0]),
        uv_(face.uv) {
    const Vec3d a = corners[1] - corners[0], b = corners[2] - corners[0];
    normal_ = cross(a, b);
    const double area = length_squared(normal_);
    to_s_ = cross(b, normal_) * (1 / area);
    to_t_ = cross(normal_, a) * (1 / area);
  }

  /// At a place of the picture, in pixels from its top left; none where the plane is not seen.
  std::optional<Vec2d> at(double x, double y) const {
    const double right = (x - half_width_) * to_plane_, up = (half_height_ - y) * to_plane_;
    const Vec3d aside = view_.right * right + view_.up * up;
    const Vec3d from = view_.perspective ? view_.eye : view_.eye + aside;
    const Vec3d along = view_.perspective ? aside - view_.back : -view_.back;
    const double distance = dot(normal_, origin_ - from) / dot(normal_, along);
    if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;
    const Vec3d p = from + along * distance - origin_;
    const double s = dot(to_s_, p), t = dot(to_t_, p);
    return uv_[0] + (uv_[1] - uv_[0]) * s + (uv_[2] - uv_[0]) * t;
  }

 private:
  const View& view_;
  double to_plane_, half_width_, half_height_;
  Vec3d origin_, normal_, to_s_, to_t_;
  std::array<Vec2d, 3> uv_;
};

std::optional<ImageSights::Sight> look(const ShownPlane& plane, int x, int y) {
  const double px = x + 0.5, py = y + 0.5;
  const auto here = plane.at(px, py), right = plane.at(px + 1, py), below = plane.at(px, py + 1);
  if (!here || !right || !below) return std::nullopt;
  const auto single = [](Vec2d a) { return Vec2f{static_cast<float>(a.x), static_cast<float>(a.y)}; };
  return ImageSights::Sight{single(*here), {single(*right - *here), single(*below - *here)}, 1};
}

/// [by an atlas's first image]
using Looks = std::map<int, std::vector<ImageSights::Sight>>;

Looks find_looks(const Model& model, const RenderScene& scene, std::span<const View> views, int size,
                 const Context& context) {
  const std::vector<Atlas> atlases = find_atlases(model);
  std::vector<AtlasLook> faces;
  for (const Atlas& atlas : atlases) faces.emplace_back(model, atlas);
  double pixels = 0;
  for (const View& view : views) pixels += static_cast<double>(size) * picture_width(view, size);
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMostLooks))));
  Looks looks;
  for (const View& view : views) {
    if (context.cancelled()) throw Error(ErrorKind::cancelled, "cancelled");
    const int width = picture_width(view, size);
    const VisibleSurface surface = visible_surface(scene, view, width, size, context);
    for (int y = stride / 2; y < size; y += stride) {
      for (int x = stride / 2; x < width; x += stride) {
        const std::uint32_t triangle =
            surface.triangle[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x)];
        if (triangle == kInvalid) continue;
        const TriangleOrigin at = origin(scene, triangle);
        const SceneMesh& mesh = scene.meshes[at.mesh];
        std::array<Vec3d, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
          corners[k] = Vec3d(mesh.surface.positions[mesh.mesh->triangles[at.face.index()][k].index()]);
        for (std::size_t a = 0; a < atlases.size(); ++a) {
          const AtlasFace* const face = faces[a].find(mesh.mesh_index, at.face);
          if (face == nullptr) continue;
          if (const auto sight = look(ShownPlane(view, size, corners, *face), x, y))
            looks[atlases[a].images.front()].push_back(*sight);
        }
      }
    }
  }
  return looks;
}

/// [by image] How finely each is seen; of those that the scene shows.
std::map<std::size_t, ResolutionMap> find_resolutions(const Model& model, const RenderScene& scene,
                                                      std::span<const View> views, int size,
                                                      const Context& context) {
  std::map<std::size_t, ResolutionMap> found;
  for (std::size_t s = 0; s < scene.images.size(); ++s) {
    const EncodedImage* const image = scene.images[s].image;
    if (image == nullptr || scene.images[s].map->width() == 0) continue;
    const auto number = static_cast<std::size_t>(image - model.images.data());
    ResolutionMap map = texel_resolution(scene, s, views, size, context);
    const auto [known, is_new] = found.try_emplace(number, map);
    if (is_new) continue;
    for (std::size_t i = 0; i < map.pixels_per_texel.size(); ++i)
      known->second.pixels_per_texel[i] =
          std::max(known->second.pixels_per_texel[i], map.pixels_per_texel[i]);
  }
  return found;
}

}  // namespace

ImageViewers camera_sights(const Model& model, const RenderScene& scene, std::span<const View> views,
                           int size, const Context& context) {
  const auto looks = std::make_shared<const Looks>(find_looks(model, scene, views, size, context));
  const auto resolutions = std::make_shared<const std::map<std::size_t, ResolutionMap>>(
      find_resolutions(model, scene, views, size, context));
  ImageViewers viewers;
  viewers.sights = [looks](const Atlas& atlas) {
    const auto found = looks->find(atlas.images.front());
    return found == looks->end() ? std::vector<ImageSights::Sight>{} : found->second;
  };
  viewers.shown = [resolutions](std::size_t image, const Image8& picture) {
    const auto map = resolutions->find(image);
    if (map == resolutions->end()) return picture;
    return reconstructed(pruned(wavelet_image(picture, kFineStep), map->second, kOctaves).image);
  };
  return viewers;
}

}  // namespace fovea
