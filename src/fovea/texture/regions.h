#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/base/prefetch.h"
#include "fovea/base/wide.h"
#include "fovea/model/ids.h"
#include "fovea/model/model.h"
#include "fovea/model/wrap.h"
#include "fovea/texture/felzenszwalb.h"

namespace fovea {

/// The region of what no triangle covers.
inline constexpr std::uint32_t kBackground = 0;

namespace regions {

/// A row of a transform of texture coordinates.
struct UvRow {
  float u, v, offset;
};

/// The texels of a row or column of `size` in which a sampler finds transformed points: `nearest_texel` of
/// what is usable.
FOVEA_WIDE_PART void find_texels(const WideFloats& u, const WideFloats& v, UvRow row, int size, Wrap wrap,
                                 WideInts& out) {
  WideFloats x = row.u * u + row.v * v + row.offset;
  x = ((x < kMostTurns) & (x > -kMostTurns)) ? x : 0.0f;
  if (wrap == Wrap::mirror) x *= 0.5f;
  if (wrap != Wrap::clamp) {
    WideInts cut;
    convert(x, cut);
    WideFloats whole;
    convert(cut, whole);
    x -= whole > x ? whole - 1 : whole;
  }
  if (wrap == Wrap::mirror) x = x > 0.5f ? 2 - 2 * x : 2 * x;
  x = x > 0 ? (x < 1 ? x : 1.0f) : 0.0f;
  convert(x * static_cast<float>(size), out);
  out = out < size ? out : size - 1;
}

}  // namespace regions

/// The regions of one part of a mesh, ready to be looked up for each pixel. Refers to a ModelRegions.
class PartRegions {
 public:
  /// The set of texture coordinates that `texels_at` wants; -1 if it looks at none.
  int uv_set() const { return uv_set_; }
  /// Whether a point's region depends on where in a texture it is, or on its face alone.
  bool is_textured() const { return !texel_label_.empty(); }
  std::uint32_t region_of(FaceId face) const {
    return face_label_.empty() ? first_ : first_ + face_label_[face.index()];
  }
  /// The texels of points, given the texture coordinates there as the mesh has them: the material's transform
  /// and its sampler's wrapping are applied here, as in pictures without filters. What is then not finite, or
  /// beyond a million, counts as 0.
  void texels_at(const WideFloats& u, const WideFloats& v, WideWords& out) const;
  /// Apart from the above, as most of the time goes into waiting for it: `prefetch` it as soon as it is
  /// known.
  std::uint32_t region_of_texel(std::uint32_t texel) const { return first_ + texel_label_[texel]; }
  void prefetch_texel(std::uint32_t texel) const { prefetch(&texel_label_[texel]); }

 private:
  friend class RegionFinder;

  std::uint32_t first_ = kBackground;  // region of label 0
  int uv_set_ = -1;
  std::span<const std::uint32_t> texel_label_;  // [height × width], or empty
  int width_ = 0, height_ = 0;
  Wrap wrap_u_ = Wrap::repeat, wrap_v_ = Wrap::repeat;
  UvMatrixf matrix_;
  std::span<const std::uint32_t> face_label_;  // [#F], or empty
};

FOVEA_WIDE_PART void PartRegions::texels_at(const WideFloats& u, const WideFloats& v, WideWords& out) const {
  WideInts x, y;
  regions::find_texels(u, v, {matrix_.u.x, matrix_.v.x, matrix_.offset.x}, width_, wrap_u_, x);
  regions::find_texels(u, v, {matrix_.u.y, matrix_.v.y, matrix_.offset.y}, height_, wrap_v_, y);
  out = reinterpret_cast<WideWords>(y) * static_cast<std::uint32_t>(width_) + reinterpret_cast<WideWords>(x);
}

/// The regions of a model. Refers to the model, which must outlive it.
class ModelRegions {
 public:
  ModelRegions(ModelRegions&&) = default;
  ModelRegions& operator=(ModelRegions&&) = default;

  /// How many there are, with the background.
  std::uint32_t count() const { return count_; }
  const PartRegions& part(std::size_t mesh, std::uint32_t part) const { return parts_[mesh][part]; }
  /// The region of a point of a triangle; `uv` as `PartRegions::texels_at` wants it.
  std::uint32_t region_at(std::size_t mesh, FaceId face, Vec2f uv) const;

 private:
  friend class RegionFinder;
  explicit ModelRegions(const Model& model) : model_(&model) {}

  const Model* model_;
  std::uint32_t count_ = 1;
  std::vector<LabelMap> images_;                         // [#images], empty where no part shows one
  std::vector<std::vector<std::uint32_t>> face_labels_;  // [#meshes][#F], empty where all have other regions
  std::vector<std::vector<PartRegions>> parts_;          // [#meshes][#parts]
};

/// What the surfaces of a model's meshes look like, as regions numbered through from 1 (González et al.,
/// "Viewpoint entropy-driven simplification method for textured triangle meshes", 2009, section 3.1; theirs
/// have one texture). Of each part:
///
/// - With a base-colour texture: the regions of the image. Parts that show the same image, multiplied by the
///   same base-colour factor, share them; another factor gives the same borders other numbers.
/// - Else with vertex colours that are not all white: the triangles of the mesh are segmented, nodes being
///   triangles, edges the edges between them, weights the distances of mean colours times the base-colour
///   factor (display values 0 … 255); `k` and `min_size` then count triangles. Triangles and not vertices,
///   so that a point's region is told by its triangle alone, as with textures and factors.
/// - Else one region for each base-colour factor that occurs, in whatever material.
///
/// Emission, the other textures and transparency are not looked at. Parts without triangles have no region.
/// Images that cannot be decoded count as absent and are reported ("image-not-shown").
///
/// Numbers are in the order in which meshes and their parts use them, coloured triangles after all other
/// parts of their mesh. One image after another, each in parallel: for time and memory see `segment_image`;
/// O(#F log #F) for coloured triangles. Throws Error(usage) for options out of range, Error(limit) for more
/// than 2³² regions, Error(cancelled).
ModelRegions model_regions(const Model& model, const SegmentOptions& options, Context& context);

}  // namespace fovea
