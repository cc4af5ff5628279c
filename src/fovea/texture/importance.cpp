#include "fovea/texture/importance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fovea/io/image_codec.h"
#include "fovea/model/check_fields.h"
#include "fovea/texture/atlas_raster.h"

namespace fovea {

namespace {

/// Of values that stand for a whole range: what is beyond counts as much.
constexpr double kHighPercentile = 0.98;

/// Width and height of maps in an atlas's proportions: those of its largest image.
std::array<int, 2> map_size(const Model& model, const Atlas& atlas, int longest_side) {
  int width = 1, height = 1;
  for (const int image : atlas.images) {
    const ImageInfo info = image_info(model.images[static_cast<std::size_t>(image)].bytes);
    if (std::int64_t{info.width} * info.height > std::int64_t{width} * height)
      width = info.width, height = info.height;
  }
  const double scale = std::min(1.0, static_cast<double>(longest_side) / std::max(width, height));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
  return {side(width), side(height)};
}

/// A triangle on the surface and in the texture.
struct FaceShape {
  double area = 0, uv_area = 0;
  double least_stretch =
      0;  ///< Smallest singular value from the surface to the texture; 0 if either has no area.
};

FaceShape shape_of(const Model& model, const AtlasFace& face, double scale) {
  const TriMesh& mesh = model.meshes[face.mesh].surface;
  const auto at = [&](std::size_t k) {
    return Vec3d(mesh.positions[mesh.triangles[face.face][k].index()]) * scale;
  };
  const Vec3d p = at(1) - at(0), q = at(2) - at(0);
  const Vec2d a = face.uv[1] - face.uv[0], b = face.uv[2] - face.uv[0];
  FaceShape shape{length(cross(p, q)) / 2, std::abs(cross(a, b)) / 2, 0};
  if (!(shape.area > 0) || !(shape.uv_area > 0)) return shape;
  // Singular values of the 3 × 2 matrix from the texture to the surface; the larger one's inverse is asked
  // for.
  const double det = cross(a, b);
  const Vec3d du = (p * b.y - q * a.y) / det, dv = (q * a.x - p * b.x) / det;
  const double e = dot(du, du), f = dot(du, dv), g = dot(dv, dv);
  const double largest = std::sqrt((e + g) / 2 + std::sqrt((e - g) * (e - g) / 4 + f * f));
  shape.least_stretch = 1 / largest;
  return shape;
}

double high_percentile(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(kHighPercentile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// TDM at the corners of triangles, 0 … 1.
std::vector<std::array<float, 3>> distortions(std::span<const AtlasFace> faces,
                                              std::span<const FaceShape> shapes) {
  struct Mean {
    double sum = 0, weight = 0;
  };
  std::vector<Mean> means;
  std::vector<double> all;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (shapes[i].least_stretch == 0) continue;
    all.push_back(1 / shapes[i].least_stretch);
    for (const std::uint32_t value : faces[i].value) {
      if (value >= means.size()) means.resize(value + std::size_t{1});
      means[value].sum += shapes[i].area * all.back();
      means[value].weight += shapes[i].area;
    }
  }
  std::vector<std::array<float, 3>> result(faces.size());
  const double most = high_percentile(std::move(all));
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t value = faces[i].value[k];
      if (value >= means.size() || means[value].weight == 0) continue;
      result[i][k] = static_cast<float>(std::min(means[value].sum / means[value].weight / most, 1.0));
    }
  }
  return result;
}

ImageF image_of(const AtlasRaster<float>& raster) {
  ImageF image(raster.width, raster.height, 1, ColorEncoding::linear);
  image.pixels = raster.texels;
  return image;
}

template <class F>
ImageF combined(const TextureImportance& maps, const F& f) {
  ImageF result = maps.coverage;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) result.pixels[i] = static_cast<float>(f(i));
  return result;
}

}  // namespace

TextureImportance texture_importance(const Model& model, const Atlas& atlas,
                                     std::span<const VertexField> field, int longest_side,
                                     const Context& context) {
  const std::vector<VertexField> fields(field.begin(), field.end());
  if (!fields.empty()) check_fields(model, fields);
  const std::vector<AtlasFace> faces = atlas_faces(model, atlas);
  const std::vector<double> scales = largest_scales(model);
  std::vector<FaceShape> shapes;
  double area = 0, uv_area = 0;
  for (const AtlasFace& face : faces) {
    shapes.push_back(shape_of(model, face, scales[face.mesh]));
    area += shapes.back().area;
    uv_area += shapes.back().uv_area;
  }
  const std::vector<std::array<float, 3>> distortion = distortions(faces, shapes);
  const std::array<int, 2> size = map_size(model, atlas, longest_side);
  const auto mixed = [](const std::array<double, 3>& weights, auto&& corner) {
    return static_cast<float>(weights[0] * corner(std::size_t{0}) + weights[1] * corner(std::size_t{1}) +
                              weights[2] * corner(std::size_t{2}));
  };
  const auto drawn = [&](auto&& value) {
    return image_of(rasterized<float>(faces, size[0], size[1], value, context));
  };
  using Weights = std::array<double, 3>;
  TextureImportance maps;
  maps.saliency = drawn([&](std::uint32_t i, const Weights& weights) {
    if (fields.empty()) return 1.0f;
    const auto& triangle = model.meshes[faces[i].mesh].surface.triangles[faces[i].face];
    return mixed(weights,
                 [&](std::size_t k) { return static_cast<double>(fields[faces[i].mesh][triangle[k]]); });
  });
  maps.distortion = drawn([&](std::uint32_t i, const Weights& weights) {
    return mixed(weights, [&](std::size_t k) { return static_cast<double>(distortion[i][k]); });
  });
  maps.coverage = drawn([&](std::uint32_t i, const Weights&) {
    if (shapes[i].uv_area == 0 || area == 0) return 0.0f;
    return static_cast<float>(shapes[i].area / shapes[i].uv_area * uv_area / area);
  });
  return maps;
}

double seen_area(const Model& model, const Atlas& atlas, std::span<const VertexField> field) {
  const std::vector<VertexField> fields(field.begin(), field.end());
  if (!fields.empty()) check_fields(model, fields);
  const std::vector<double> scales = largest_scales(model);
  double sum = 0;
  for (const AtlasFace& face : atlas_faces(model, atlas)) {
    double looked_at = 1;
    if (!fields.empty()) {
      looked_at = 0;
      for (const VertexId v : model.meshes[face.mesh].surface.triangles[face.face])
        looked_at += static_cast<double>(fields[face.mesh][v]) / 3;
    }
    sum += looked_at * shape_of(model, face, scales[face.mesh]).area;
  }
  return sum;
}

ImageF saliency_importance(const TextureImportance& maps) {
  return combined(maps, [&](std::size_t i) { return maps.saliency.pixels[i] * maps.distortion.pixels[i]; });
}

ImageF frequency_importance(const TextureImportance& maps) {
  return combined(maps, [&](std::size_t i) { return std::sqrt(maps.detail.pixels[i]); });
}

ImageF balanced_importance(const TextureImportance& maps) {
  return combined(maps, [&](std::size_t i) {
    return std::sqrt(std::sqrt(maps.saliency.pixels[i] * maps.coverage.pixels[i] * maps.detail.pixels[i]));
  });
}

}  // namespace fovea
