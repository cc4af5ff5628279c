#include "fovea/texture/seam_jump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "fovea/io/image_decoder.h"
#include "fovea/model/texture_use.h"
#include "fovea/surface/half_edges.h"
#include "fovea/texture/texel_scan.h"
#include "fovea/texture/uv_map.h"

namespace fovea {

namespace {

/// Points that an edge is looked at in, at most.
constexpr double kMostPoints = 1 << 14;

/// An edge as one of its triangles has it in the texture.
using Side = std::array<Vec2d, 2>;

double texels(const Image8& image, const Side& side) {
  return std::hypot((side[1].x - side[0].x) * image.width, (side[1].y - side[0].y) * image.height);
}

/// Mean along the edge.
double jump(const Image8& image, const Sampler& sampler, const Side& a, const Side& b) {
  const auto points =
      static_cast<int>(std::clamp(std::ceil(std::max(texels(image, a), texels(image, b))), 1.0, kMostPoints));
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double t = (i + 0.5) / points;
    const auto p = looked_up(image, a[0] * (1 - t) + a[1] * t, sampler),
               q = looked_up(image, b[0] * (1 - t) + b[1] * t, sampler);
    const auto colors = static_cast<std::size_t>(image.color_channels());
    for (std::size_t k = 0; k < colors; ++k) sum += std::abs(p[k] - q[k]) / static_cast<double>(colors);
  }
  return sum / points;
}

/// A base colour that materials read, with its texels.
struct BaseColor {
  TextureUse use;
  Image8 image;
};

class SeamScan {
 public:
  SeamScan(const Model& model, Context& context) : model_(model), context_(context), decoder_(model) {}

  void add(const TriMesh& mesh, double scale) {
    const std::vector<HalfEdge> sorted = sorted_half_edges(mesh.triangles);
    for_each_edge(sorted, [&](std::span<const HalfEdge> edge) {
      if (edge.size() != 2) return;
      const Part &part = mesh.parts[mesh.face_part[edge[0].triangle()]],
                 &other = mesh.parts[mesh.face_part[edge[1].triangle()]];
      if (part.material != other.material) return;
      const BaseColor* color = base_color(part);
      if (color == nullptr) return;
      const auto a = side(mesh, color->use, edge[0]), b = side(mesh, color->use, edge[1]);
      if (!a || !b || *a == *b) return;
      add(jump(color->image, color->use.sampler, *a, *b), scale * edge_length(mesh, edge[0]));
    });
  }

  SeamJump take() const {
    SeamJump result = found_;
    if (result.length > 0) result.mean = sum_ / result.length;
    return result;
  }

 private:
  static double edge_length(const TriMesh& mesh, const HalfEdge& edge) {
    const auto at = [&](std::size_t corner) {
      return Vec3d(mesh.positions[mesh.triangles[corner / 3][corner % 3].index()]);
    };
    return length(at(edge.high_corner()) - at(edge.low_corner()));
  }

  static std::optional<Side> side(const TriMesh& mesh, const TextureUse& use, const HalfEdge& edge) {
    const UvMap map(mesh, use);
    if (map.layer == nullptr) return {};
    const auto triangle = map.triangle(edge.triangle());
    if (!triangle) return {};
    return Side{(*triangle)[edge.low_corner() % 3], (*triangle)[edge.high_corner() % 3]};
  }

  /// Null if there is no image, or none that can be decoded.
  const BaseColor* base_color(const Part& part) {
    const auto [at, is_new] = colors_.try_emplace(part.material);
    if (is_new) {
      if (const auto use = resolve(model_, material_of(model_, part).base_color)) {
        if (auto image = decoder_.decode(static_cast<std::size_t>(use->image), context_))
          at->second = BaseColor{*use, std::move(*image)};
      }
    }
    return at->second ? &*at->second : nullptr;
  }

  void add(double jump, double length) {
    sum_ += jump * length;
    found_.length += length;
    found_.largest = std::max(found_.largest, jump);
    ++found_.edges;
  }

  const Model& model_;
  Context& context_;
  ImageDecoder decoder_;
  std::map<int, std::optional<BaseColor>> colors_;  // of materials
  SeamJump found_;
  double sum_ = 0;
};

}  // namespace

SeamJump seam_jump(const Model& model, Context& context) {
  SeamScan scan(model, context);
  const std::vector<double> scales = largest_scales(model);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (scales[m] > 0) scan.add(model.meshes[m].surface, scales[m]);
  }
  return scan.take();
}

}  // namespace fovea
