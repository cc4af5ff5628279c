#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "fovea/base/math.h"

namespace fovea {

/// How texture coordinates outside [0, 1] are read; the values are glTF's own.
enum class Wrap : int { clamp = 33071, mirror = 33648, repeat = 10497 };

/// Wrapping and filtering of a texture. Filters keep glTF's numbers (9728 nearest … 9987
/// trilinear); none leaves the choice to the viewer.
struct Sampler {
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  std::optional<int> mag_filter;
  std::optional<int> min_filter;
  std::string json;
};

/// An image with its sampler. Indices into the model; -1 for none (default sampler).
struct Texture {
  int image = -1;
  int sampler = -1;
  std::string name;
  std::string json;
};

/// KHR_texture_transform: uv' = offset + R(rotation_rad) · (scale · uv).
struct TextureTransform {
  Vec2d offset{0, 0};
  double rotation_rad = 0;
  Vec2d scale{1, 1};
  friend bool operator==(const TextureTransform&, const TextureTransform&) = default;
};

/// The same as a matrix: uv' = u · uv.x + v · uv.y + offset.
template <class T>
struct UvMatrix {
  Vec2<T> u{1, 0}, v{0, 1}, offset{0, 0};
  Vec2<T> operator()(Vec2<T> uv) const { return direction(uv) + offset; }
  /// Of a difference of coordinates.
  Vec2<T> direction(Vec2<T> d) const { return u * d.x + v * d.y; }
  friend bool operator==(const UvMatrix&, const UvMatrix&) = default;
};
using UvMatrixf = UvMatrix<float>;
using UvMatrixd = UvMatrix<double>;

/// A material's use of a texture.
struct TextureRef {
  int texture = -1;
  int uv_set = 0;
  std::optional<TextureTransform> transform;
  friend bool operator==(const TextureRef&, const TextureRef&) = default;
};

enum class AlphaMode { opaque, mask, blend };

/// glTF's metallic-roughness material. What extensions add (clear coat, sheen, ...) stays in `json`.
struct Material {
  std::string name;
  std::array<double, 4> base_color_factor{1, 1, 1, 1};  ///< Linear RGBA.
  std::optional<TextureRef> base_color;                 ///< sRGB RGBA.
  double metallic_factor = 1;
  double roughness_factor = 1;
  std::optional<TextureRef> metallic_roughness;  ///< Linear; roughness in G, metal in B.
  std::optional<TextureRef> normal;              ///< Linear, tangent space.
  double normal_scale = 1;
  std::optional<TextureRef> occlusion;  ///< Linear, in R.
  double occlusion_strength = 1;
  std::optional<TextureRef> emissive;  ///< sRGB.
  std::array<double, 3> emissive_factor{0, 0, 0};
  AlphaMode alpha_mode = AlphaMode::opaque;
  double alpha_cutoff = 0.5;
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit.
  std::string json;
};

}  // namespace fovea
