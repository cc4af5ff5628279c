#include "fovea/render/texel_density.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fovea/base/parallel.h"
#include "fovea/io/image_codec.h"
#include "fovea/render/projection.h"
#include "fovea/render/render.h"
#include "fovea/texture/texture_read.h"
#include "fovea/texture/uv_map.h"

namespace fovea {

namespace {

constexpr int kFirstOctave = -10;

/// A way in which a part of a mesh shows an image.
struct Look {
  std::size_t image = 0;
  UvMap map;
  Vec2d texels;  // sides of the image
};

bool is_same(const Look& a, const Look& b) {
  return a.image == b.image && a.map.layer == b.map.layer && a.map.matrix == b.map.matrix;
}

using Looks = std::vector<std::vector<std::vector<Look>>>;  // [#meshes of the scene][#parts]

Looks looks_of(const Model& model, const RenderScene& scene) {
  std::vector<Vec2d> sizes;
  for (const EncodedImage& image : model.images) {
    const ImageInfo info = image_info(image.bytes);
    sizes.push_back({static_cast<double>(info.width), static_cast<double>(info.height)});
  }
  Looks looks(scene.meshes.size());
  for (std::size_t m = 0; m < looks.size(); ++m) {
    const TriMesh& mesh = *scene.meshes[m].mesh;
    for (const Part& part : mesh.parts) {
      std::vector<Look>& list = looks[m].emplace_back();
      for (const int material : part_materials(model, part)) {
        if (material < 0) continue;
        for (const TextureRead& read :
             texture_reads(model, model.materials[static_cast<std::size_t>(material)])) {
          const auto image = static_cast<std::size_t>(read.image);
          TextureUse use;
          use.uv_set = read.uv_set;
          use.matrix = read.matrix;
          const Look look{image, UvMap(mesh, use), sizes[image]};
          if (look.map.layer == nullptr || !(sizes[image].x > 0)) continue;
          if (std::ranges::none_of(list, [&](const Look& l) { return is_same(l, look); }))
            list.push_back(look);
        }
      }
    }
  }
  return looks;
}

/// A triangle as a view sees it: weights of its corners, up to a common factor, are linear on the picture.
class SeenTriangle {
 public:
  SeenTriangle(const View& view, const SceneMesh& mesh, FaceId face) {
    std::array<Vec3d, 3> eye;
    for (std::size_t k = 0; k < 3; ++k) {
      eye[k] = view.to_eye(Vec3d(mesh.surface.positions[mesh.mesh->triangles[face.index()][k].index()]));
      if (!view.perspective) eye[k].z = 1;
    }
    for (std::size_t k = 0; k < 3; ++k) planes_[k] = cross(eye[(k + 1) % 3], eye[(k + 2) % 3]);
  }

  /// How coordinates change along the plane of the picture at a point of it, to the right and up.
  std::array<Vec2d, 2> slopes(const std::array<Vec2d, 3>& uv, Vec2d at) const {
    const Vec3d ray{at.x, at.y, 1};
    double sum = 0, sum_x = 0, sum_y = 0;
    Vec2d value{}, along_x{}, along_y{};  // from the first corner on
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& plane = planes_[k];
      const double weight = dot(plane, ray);
      sum += weight;
      sum_x += plane.x;
      sum_y += plane.y;
      const Vec2d off = uv[k] - uv[0];
      value = value + off * weight;
      along_x = along_x + off * plane.x;
      along_y = along_y + off * plane.y;
    }
    value = value * (1 / sum);
    return {(along_x - value * sum_x) * (1 / sum), (along_y - value * sum_y) * (1 / sum)};
  }

 private:
  std::array<Vec3d, 3> planes_;
};

/// The smaller singular value of the matrix with these columns; none if it is not a finite number above 0.
std::optional<double> least_stretch(Vec2d a, Vec2d b) {
  const double e = a.x * a.x + a.y * a.y, f = a.x * b.x + a.y * b.y, g = b.x * b.x + b.y * b.y;
  const double largest = std::sqrt((e + g) / 2 + std::sqrt((e - g) * (e - g) / 4 + f * f));
  const double least = std::abs(cross(a, b)) / largest;
  // What is thinner by so much is a line.
  constexpr double kThin = 1e-6;
  if (!std::isfinite(least) || !(least > kThin * largest)) return std::nullopt;
  return least;
}

void add_view(const RenderScene& scene, const Looks& looks, const View& view, int size,
              const Context& context, std::vector<TexelDensity>& densities) {
  const int width = picture_width(view, size);
  const VisibleSurface surface = visible_surface(scene, view, width, size, context);
  const Projection projection(view, {width, size, 1});
  const double height = projection.pixel() * size;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint32_t triangle =
          surface.triangle[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x)];
      if (triangle == kInvalid) continue;
      const TriangleOrigin from = origin(scene, triangle);
      const SceneMesh& mesh = scene.meshes[from.mesh];
      const SeenTriangle seen(view, mesh, from.face);
      for (const Look& look : looks[from.mesh][mesh.mesh->face_part[from.face.index()]]) {
        const auto uv = look.map.triangle(from.face.value);
        if (!uv) continue;
        auto slopes = seen.slopes(*uv, projection.to_plane(x + 0.5, y + 0.5));
        for (Vec2d& slope : slopes)
          slope = {slope.x * look.texels.x * height, slope.y * look.texels.y * height};
        if (const auto texels = least_stretch(slopes[0], slopes[1])) densities[look.image].add(*texels);
      }
    }
  }
}

}  // namespace

void TexelDensity::add(double texels) {
  const double step = std::floor(kSteps * (std::log2(texels) - kFirstOctave));
  ++counts_[static_cast<std::size_t>(std::clamp(step, 0.0, kSteps * kOctaves - 1.0))];
  ++pixels_;
}

TexelDensity& TexelDensity::operator+=(const TexelDensity& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  pixels_ += other.pixels_;
  is_used = is_used || other.is_used;
  return *this;
}

double TexelDensity::quantile(double part) const {
  if (pixels_ == 0) return 0;
  const double below = part * static_cast<double>(pixels_);
  std::uint64_t sum = 0;
  std::size_t step = 0;
  for (; step + 1 < counts_.size(); ++step) {
    sum += counts_[step];
    if (static_cast<double>(sum) > below) break;
  }
  return std::exp2(static_cast<double>(step) / kSteps + kFirstOctave);
}

std::vector<TexelDensity> texel_densities(const Model& model, const RenderScene& scene,
                                          std::span<const View> views, int size, const Context& context) {
  const Looks looks = looks_of(model, scene);
  std::vector<std::vector<TexelDensity>> of_views(views.size());
  parallel_for_or_throw(context, views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      of_views[v].resize(model.images.size());
      add_view(scene, looks, views[v], size, context, of_views[v]);
    }
  });
  std::vector<TexelDensity> sum(model.images.size());
  for (const auto& parts : looks) {
    for (const auto& list : parts) {
      for (const Look& look : list) sum[look.image].is_used = true;
    }
  }
  for (const auto& densities : of_views) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += densities[i];
  }
  return sum;
}

std::vector<double> needed_scales(std::span<const TexelDensity> densities, double height) {
  std::vector<double> scales;
  for (const TexelDensity& density : densities) {
    if (!density.is_used) {
      scales.push_back(1);
    } else if (density.pixels() == 0) {
      scales.push_back(kUnseenScale);
    } else {
      const double halvings = std::floor(kSpare - std::log2(height / density.quantile(kCoarsePixels)));
      scales.push_back(std::clamp(std::exp2(-halvings), kUnseenScale, 1.0));
    }
  }
  return scales;
}

}  // namespace fovea
