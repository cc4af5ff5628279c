#include "fovea/budget/seen_detail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/model/wrap.h"
#include "fovea/render/render.h"
#include "fovea/texture/texel_scan.h"

namespace fovea {

namespace {

/// A point in a picture, in pixels from its top left, and its distance in front of the eye's plane.
struct ScreenPoint {
  Vec2d at;
  double distance = 0;
};

/// What one view sees of a scene.
class Sight {
 public:
  Sight(const RenderScene& scene, const View& view, int size, const Context& context)
      : view_(view),
        width_(picture_width(view, size)),
        height_(size),
        surface_(visible_surface(scene, view, width_, height_, context)) {}

  /// None behind the eye's plane.
  std::optional<ScreenPoint> project(Vec3d world) const {
    const Vec3d eye = view_.to_eye(world);
    if (!(eye.z > view_.near)) return {};
    const double depth = view_.perspective ? eye.z : 1;
    const double pixels = height_ / (2 * view_.half_height);  // to a unit at distance 1
    return ScreenPoint{{width_ / 2.0 + pixels * eye.x / depth, height_ / 2.0 - pixels * eye.y / depth},
                       eye.z};
  }

  /// In the picture, and nothing is clearly nearer to the eye within a pixel of it.
  bool shows(const ScreenPoint& p) const {
    if (!(p.at.x >= 0 && p.at.y >= 0 && p.at.x < width_ && p.at.y < height_)) return false;
    constexpr double kNearly = 1.002;  // Surfaces slope inside of a pixel.
    const int x = static_cast<int>(p.at.x), y = static_cast<int>(p.at.y);
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height_ - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width_ - 1); ++i) {
        const auto pixel =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i);
        if (p.distance <= kNearly * static_cast<double>(surface_.distance[pixel])) return true;
      }
    }
    return false;
  }

  const VisibleSurface& surface() const { return surface_; }

 private:
  const View& view_;
  int width_, height_;
  VisibleSurface surface_;
};

/// The larger singular value of the matrix with these columns.
double largest_stretch(Vec2d a, Vec2d b) {
  const double e = a.x * a.x + a.y * a.y, f = a.x * b.x + a.y * b.y, g = b.x * b.x + b.y * b.y;
  return std::sqrt((e + g) / 2 + std::sqrt((e - g) * (e - g) / 4 + f * f));
}

/// How many pixels a texel takes on a triangle; none if that is not known.
std::optional<double> pixels_per_texel(const std::array<Vec2d, 3>& screen,
                                       const std::array<Vec2d, 3>& texels) {
  const Vec2d s1 = screen[1] - screen[0], s2 = screen[2] - screen[0];
  const Vec2d t1 = texels[1] - texels[0], t2 = texels[2] - texels[0];
  const double area = cross(t1, t2);
  // Columns of the matrix that takes texels to pixels.
  const double stretch =
      largest_stretch((s1 * t2.y - s2 * t1.y) * (1 / area), (s2 * t1.x - s1 * t2.x) * (1 / area));
  if (!std::isfinite(stretch)) return {};
  return stretch;
}

/// How a material looks at an image, if it does.
std::vector<const SceneTexture*> looks_at(const SceneMaterial& material, int image) {
  std::vector<const SceneTexture*> looks;
  for (const auto* texture :
       {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
        &material.occlusion_texture, &material.emissive_texture}) {
    if (*texture && (*texture)->image == image) looks.push_back(&**texture);
  }
  return looks;
}

/// A map that grows.
class MapCanvas {
 public:
  MapCanvas(int width, int height) : width_(width), height_(height) {
    map_.columns = (width + ResolutionMap::kCell - 1) / ResolutionMap::kCell;
    map_.rows = (height + ResolutionMap::kCell - 1) / ResolutionMap::kCell;
    map_.pixels_per_texel.assign(static_cast<std::size_t>(map_.columns) * static_cast<std::size_t>(map_.rows),
                                 0.0f);
  }

  /// A triangle in texels.
  void add(const std::array<Vec2d, 3>& texels, const Sampler& sampler, double pixels) {
    std::array<Vec2d, 3> cells;
    for (std::size_t k = 0; k < 3; ++k) {
      cells[k] = texels[k] * (1.0 / ResolutionMap::kCell);
      mark(static_cast<std::int64_t>(std::floor(cells[k].x)),
           static_cast<std::int64_t>(std::floor(cells[k].y)), sampler, pixels);
    }
    for_texel_rows(cells, 1, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
      for (std::int64_t x = begin; x < end; ++x) mark(x, y, sampler, pixels);
    });
  }

  /// With the largest number of each square and those around it.
  ResolutionMap finish() {
    ResolutionMap wide = map_;
    for (int y = 0; y < map_.rows; ++y) {
      for (int x = 0; x < map_.columns; ++x) {
        float& most = wide.pixels_per_texel[index(x, y)];
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, map_.rows - 1); ++j) {
          for (int i = std::max(x - 1, 0); i <= std::min(x + 1, map_.columns - 1); ++i)
            most = std::max(most, map_.pixels_per_texel[index(i, j)]);
        }
      }
    }
    return wide;
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.columns) + static_cast<std::size_t>(x);
  }
  void mark(std::int64_t x, std::int64_t y, const Sampler& sampler, double pixels) {
    const int column = wrapped_texel(x * ResolutionMap::kCell, width_, sampler.wrap_u) / ResolutionMap::kCell;
    const int row = wrapped_texel(y * ResolutionMap::kCell, height_, sampler.wrap_v) / ResolutionMap::kCell;
    float& cell = map_.pixels_per_texel[index(column, row)];
    cell = std::max(cell, static_cast<float>(pixels));
  }

  int width_, height_;
  ResolutionMap map_;
};

/// Where the triangles of a mesh lie in an image.
struct ImageLook {
  const AttributeLayer* uv;
  const SceneTexture* texture;
  double width, height;

  std::optional<std::array<Vec2d, 3>> texels(std::size_t face) const {
    std::array<Vec2d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const ValueId id = uv->corner_value[3 * face + k];
      if (!id.valid()) return {};
      const float* const value = uv->value(id);
      if (!(std::abs(value[0]) < kMostTurns && std::abs(value[1]) < kMostTurns)) return {};
      const Vec2f at = texture->matrix({value[0], value[1]});
      corners[k] = {static_cast<double>(at.x) * width, static_cast<double>(at.y) * height};
    }
    return corners;
  }
};

void add_view(const RenderScene& scene, int image, const Sight& sight, MapCanvas& canvas) {
  std::vector<bool> is_seen(scene.triangle_count, false);
  for (const std::uint32_t t : sight.surface().triangle) {
    if (t != kInvalid) is_seen[t] = true;
  }
  const MipMap& map = *scene.images[static_cast<std::size_t>(image)].map;
  for (const SceneMesh& mesh : scene.meshes) {
    for (std::size_t f = 0; f < mesh.mesh->face_count(); ++f) {
      const SceneMaterial& material = scene.materials[mesh.part_material[mesh.mesh->face_part[f]]];
      const std::vector<const SceneTexture*> looks = looks_at(material, image);
      if (looks.empty()) continue;
      std::array<Vec2d, 3> screen;
      bool is_near = is_seen[mesh.first_triangle + f], is_whole = true;
      for (std::size_t k = 0; k < 3 && is_whole; ++k) {
        const auto p = sight.project(Vec3d(mesh.surface.positions[mesh.mesh->triangles[f][k].index()]));
        is_whole = p.has_value();
        if (!p) break;
        screen[k] = p->at;
        is_near = is_near || sight.shows(*p);
      }
      if (!is_whole || !is_near) continue;
      // On the screen y grows downwards: what faces the eye is clockwise there.
      const bool faces_eye =
          (cross(screen[1] - screen[0], screen[2] - screen[0]) < 0) != mesh.surface.mirrored;
      if (!faces_eye && !material.double_sided) continue;
      for (const SceneTexture* texture : looks) {
        const auto set = static_cast<std::size_t>(texture->uv_set);
        if (set >= mesh.uv.size() || mesh.uv[set] == nullptr) continue;
        const ImageLook look{mesh.uv[set], texture, static_cast<double>(map.width()),
                             static_cast<double>(map.height())};
        const auto texels = look.texels(f);
        if (!texels) continue;
        const auto pixels = pixels_per_texel(screen, *texels);
        if (pixels) canvas.add(*texels, texture->sampler, *pixels);
      }
    }
  }
}

}  // namespace

ResolutionMap texel_resolution(const RenderScene& scene, std::size_t image, std::span<const View> views,
                               int size, const Context& context) {
  const MipMap& map = *scene.images[image].map;
  MapCanvas canvas(map.width(), map.height());
  for (const View& view : views) {
    if (context.cancelled()) throw Error(ErrorKind::cancelled, "cancelled");
    add_view(scene, static_cast<int>(image), Sight(scene, view, size, context), canvas);
  }
  return canvas.finish();
}

std::vector<float> height_weights(const HeightField& field, const RenderScene& scene,
                                  std::span<const View> views, int size, const Context& context) {
  std::vector<double> squares(field.points.size(), 0.0);
  Vec3d up{};
  (field.up == 0 ? up.x : field.up == 1 ? up.y : up.z) = 1;
  const auto world = [&](int x, int y) {
    const int column = std::clamp(x, 0, field.columns - 1), row = std::clamp(y, 0, field.rows - 1);
    return Vec3d(field.points[static_cast<std::size_t>(row) * static_cast<std::size_t>(field.columns) +
                              static_cast<std::size_t>(column)]);
  };
  const double cell = length(world(1, 1) - world(0, 0));
  for (const View& view : views) {
    const Sight sight(scene, view, size, context);
    const auto seen = [&](Vec3d p) { return sight.project(transform_point(field.to_world, p)); };
    parallel_for_or_throw(context, squares.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const int x = static_cast<int>(i % static_cast<std::size_t>(field.columns)),
                  y = static_cast<int>(i / static_cast<std::size_t>(field.columns));
        const auto here = seen(world(x, y)), left = seen(world(x - 1, y)), right = seen(world(x + 1, y)),
                   above = seen(world(x, y - 1)), below = seen(world(x, y + 1)),
                   higher = seen(world(x, y) + up * cell);
        if (!here || !left || !right || !above || !below || !higher || !sight.shows(*here)) continue;
        // Border points have half of the neighbourhood, and stand for half of it.
        const double pixels = std::abs(cross(right->at - left->at, below->at - above->at)) / 4;
        const Vec2d move = (higher->at - here->at) * (1 / cell);
        squares[i] += pixels * (move.x * move.x + move.y * move.y);
      }
    });
  }
  std::vector<float> weights;
  weights.reserve(squares.size());
  for (const double s : squares) weights.push_back(static_cast<float>(std::sqrt(s)));
  return weights;
}

}  // namespace fovea
