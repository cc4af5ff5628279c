#include "fovea/saliency/surface_signals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>

#include "fovea/base/parallel.h"
#include "fovea/io/image_decoder.h"
#include "fovea/model/image_fit.h"
#include "fovea/model/texture_use.h"
#include "fovea/saliency/material_texels.h"
#include "fovea/surface/surface.h"
#include "fovea/texture/uv_map.h"

namespace fovea {

namespace {

constexpr std::size_t kFaceGrain = 1 << 9;
constexpr std::size_t kVertexGrain = 1 << 12;
/// Texels of one texture that triangles look at.
constexpr double kMostLooks = 1 << 25;
/// Triangles have no fewer texels than this part of what others of their area have: a texture of a few
/// colours may give each triangle one point.
constexpr double kLeastDensity = 0.01;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

Vec3d color_factor(const Material& material) {
  const auto& c = material.base_color_factor;
  return {c[0], c[1], c[2]};
}
Vec3d emission_factor(const Material& material) {
  const auto& c = material.emissive_factor;
  return {c[0], c[1], c[2]};
}

/// What a material multiplies red, green and blue of its texture by; x and y of its normal map.
std::array<double, 3> factor_of(const Material& material, TextureRole role) {
  const auto array = [](Vec3d x) { return std::array<double, 3>{x.x, x.y, x.z}; };
  switch (role) {
    case TextureRole::base_color: return array(color_factor(material));
    case TextureRole::emissive: return array(emission_factor(material));
    case TextureRole::metallic_roughness: return {1, material.roughness_factor, material.metallic_factor};
    case TextureRole::normal: return {material.normal_scale, material.normal_scale, 1};
    case TextureRole::occlusion: break;
  }
  return {1, 1, 1};
}

bool is_wanted(Signal signal, const SurfaceSignalOptions& options) {
  switch (signal) {
    case Signal::intensity:
    case Signal::opponency:
    case Signal::entropy: return true;
    case Signal::emission: return options.emission;
    case Signal::roughness: return options.roughness;
    case Signal::metalness: return options.metalness;
    case Signal::normal_detail: return options.normal_detail;
  }
  return false;
}

bool is_wanted(TextureRole role, const SurfaceSignalOptions& options) {
  return is_wanted(first_signal(role), options) ||
         (role == TextureRole::metallic_roughness && options.metalness);
}

/// A part of a mesh that uses a source.
struct Use {
  std::size_t mesh = 0;
  std::uint32_t part = 0;
  UvMap map;
};

/// The vertex colours of a mesh.
class VertexColors {
 public:
  explicit VertexColors(const TriMesh& mesh) : layer_(mesh.find(Semantic::color)) {
    tints_ = layer_ != nullptr && !is_white(*layer_);
  }
  /// Whether any is not white.
  bool tints() const { return tints_; }
  /// Light, 0 … 1; white where there is none.
  Vec3f light(std::size_t corner) const {
    if (!tints_) return {1, 1, 1};
    const ValueId id = layer_->corner_value[corner];
    if (!id.valid()) return {1, 1, 1};
    const float* const c = layer_->value(id);
    const auto part = [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; };
    return {part(c[0]), part(c[1]), part(c[2])};
  }

 private:
  const AttributeLayer* layer_ = nullptr;
  bool tints_ = false;
};

/// A mesh on its way: what is known of its triangles.
struct MeshState {
  const TriMesh* mesh = nullptr;
  VertexColors colors;
  std::vector<std::uint32_t> first_face, faces;     // of each part [#parts + 1], [#F]
  std::array<std::vector<float>, kSignals> values;  // [#F × 3], kNone without texture; empty if not wanted
  std::vector<float> texels;                        // [#F], of the base colour; kNone without

  MeshState(const TriMesh& triangles, const SurfaceSignalOptions& options)
      : mesh(&triangles), colors(triangles) {
    first_face.assign(mesh->parts.size() + 1, 0);
    for (const std::uint32_t part : mesh->face_part) ++first_face[part + 1];
    for (std::size_t i = 0; i + 1 < first_face.size(); ++i) first_face[i + 1] += first_face[i];
    faces.resize(mesh->face_count());
    std::vector<std::uint32_t> next = first_face;
    for (std::uint32_t f = 0; f < faces.size(); ++f) faces[next[mesh->face_part[f]]++] = f;
    texels.assign(mesh->face_count(), kNone);
    for (std::size_t s = 0; s < kSignals; ++s) {
      if (is_wanted(static_cast<Signal>(s), options)) values[s].assign(3 * mesh->face_count(), kNone);
    }
  }
  std::span<const std::uint32_t> faces_of(std::uint32_t part) const {
    return std::span(faces).subspan(first_face[part], first_face[part + 1] - first_face[part]);
  }
  bool is_tinted(std::uint32_t face) const {
    if (!colors.tints()) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (colors.light(std::size_t{3} * face + k) != Vec3f{1, 1, 1}) return true;
    }
    return false;
  }
};

Vec3f product(Vec3f a, Vec3f b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

std::array<Vec2d, 3> in_texels(const std::array<Vec2d, 3>& triangle, int width, int height) {
  std::array<Vec2d, 3> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = {triangle[k].x * width, triangle[k].y * height};
  return result;
}

/// About how many texels, and rows of them, a triangle covers that is given in texels.
struct Cover {
  double texels = 0, rows = 0;
};
Cover cover(const std::array<Vec2d, 3>& t) {
  const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
  return {0.5 * std::abs(cross(t[1] - t[0], t[2] - t[0])), high - low};
}

/// How many texels and rows are to be looked at for a triangle.
double looks(const Cover& c) { return 1 + c.texels + c.rows; }

/// Distance of the texels to be looked at for these to be about `most`. Odd, so that those of a texture that
/// repeats differ if its size is a power of two.
std::int64_t step_of(const Cover& c, double most) {
  if (looks(c) <= most) return 1;
  const double ratio = std::max(std::sqrt(c.texels / most), c.rows / most);
  return 2 * static_cast<std::int64_t>(std::ceil(0.5 * (ratio - 1))) + 1;
}

/// The signals of all meshes of a model, texture by texture.
class SignalMaker {
 public:
  SignalMaker(const Model& model, std::span<const std::size_t> meshes, const SurfaceSignalOptions& options,
              Context& context)
      : model_(model), options_(options), context_(context), decoder_(model) {
    for (const std::size_t mesh : meshes) states_.emplace_back(model.meshes[mesh].surface, options);
    for (std::size_t i = 0; i < states_.size(); ++i) find_uses(i);
  }

  std::vector<SurfaceSignals> run() {
    std::optional<Image8> image;
    int decoded = -1;
    double done = 0;
    for (const auto& [source, uses] : uses_) {
      context_.advance_or_throw("textures", done++ / static_cast<double>(uses_.size()));
      if (source.image != decoded) image = decode(source.image);
      decoded = source.image;
      if (image) look(source, *image, uses);
    }
    std::vector<SurfaceSignals> result;
    for (MeshState& state : states_) {
      result.push_back(at_vertices(state));
      state.values = {};
    }
    return result;
  }

 private:
  void find_uses(std::size_t index) {
    const TriMesh& mesh = *states_[index].mesh;
    for (std::uint32_t part = 0; part < mesh.parts.size(); ++part) {
      if (states_[index].faces_of(part).empty()) continue;
      const Material& material = material_of(model_, mesh.parts[part]);
      for (const TextureRole role : kSignalRoles) {
        if (!is_wanted(role, options_)) continue;
        const std::optional<TextureUse> texture = resolve(model_, texture_ref(material, role));
        if (!texture) continue;
        const UvMap map(mesh, *texture);
        if (map.layer == nullptr) continue;
        uses_[{texture->image, role, texture->sampler.wrap_u, texture->sampler.wrap_v,
               factor_of(material, role)}]
            .push_back({index, part, map});
      }
    }
  }

  /// The image no larger than texels are judged; none if it cannot be decoded.
  std::optional<Image8> decode(int image) {
    std::optional<Image8> decoded = decoder_.decode(static_cast<std::size_t>(image), context_);
    if (decoded) decoded = fitted(*decoded, kMostTexels, context_);
    return decoded;
  }

  /// Looks at the texels of a source for all triangles that use it.
  void look(const TexelSource& source, const Image8& image, const std::vector<Use>& uses) {
    const bool tinted = source.role == TextureRole::base_color &&
                        std::any_of(uses.begin(), uses.end(),
                                    [&](const Use& use) { return states_[use.mesh].colors.tints(); });
    const MaterialTexels texels(source, image, tinted, options_.texture, context_);
    const double most = most_looks(texels, uses);
    for (const Use& use : uses) {
      MeshState& state = states_[use.mesh];
      const std::span<const std::uint32_t> faces = state.faces_of(use.part);
      parallel_for(context_, faces.size(), kFaceGrain, [&](std::size_t begin, std::size_t end) {
        for (const std::uint32_t face : faces.subspan(begin, end - begin))
          look(source, texels, use.map, most, state, face);
      });
    }
  }

  void look(const TexelSource& source, const MaterialTexels& texels, const UvMap& map, double most,
            MeshState& state, std::uint32_t face) const {
    const auto uv = map.triangle(face);
    if (!uv) return;
    const std::array<Vec2d, 3> triangle = in_texels(*uv, texels.width(), texels.height());
    const Cover covered = cover(triangle);
    const std::int64_t step = step_of(covered, most);
    const std::size_t c = std::size_t{3} * face;
    const bool tinted = source.role == TextureRole::base_color && state.is_tinted(face);
    const TexelMeans means =
        tinted ? texels.means(triangle, step,
                              {state.colors.light(c), state.colors.light(c + 1), state.colors.light(c + 2)})
               : texels.means(triangle, step);
    for (std::size_t s = 0; s < texels.signal_count(); ++s) {
      std::vector<float>& values = state.values[static_cast<std::size_t>(first_signal(source.role)) + s];
      if (values.empty()) continue;
      for (std::size_t k = 0; k < 3; ++k) values[c + k] = means.mean(s, k);
    }
    if (source.role == TextureRole::base_color) state.texels[face] = static_cast<float>(covered.texels);
  }

  /// How many texels a triangle may look at, as a power of two, for all together to stay below kMostLooks.
  double most_looks(const MaterialTexels& texels, const std::vector<Use>& uses) const {
    constexpr std::size_t kSizes = 64;
    std::array<double, kSizes> count{}, sum{};  // of triangles that look at 2^i texels, up to twice that
    for (const Use& use : uses) {
      for (const std::uint32_t face : states_[use.mesh].faces_of(use.part)) {
        const auto uv = use.map.triangle(face);
        if (!uv) continue;
        const double n = looks(cover(in_texels(*uv, texels.width(), texels.height())));
        const auto size = std::min(static_cast<std::size_t>(std::ilogb(n)), kSizes - 1);
        count[size] += 1;
        sum[size] += n;
      }
    }
    double below = std::accumulate(sum.begin(), sum.end(), 0.0), above = 0;
    std::size_t size = kSizes;
    while (size > 0 && below + above * std::ldexp(1.0, static_cast<int>(size)) > kMostLooks) {
      --size;
      below -= sum[size];
      above += count[size];
    }
    return std::ldexp(1.0, static_cast<int>(size));
  }

  /// What a signal is at a corner whose triangle has no texture for it.
  static float without_texture(Signal signal, const Material& material, Vec3f tint) {
    switch (signal) {
      case Signal::intensity:
      case Signal::opponency: {
        const ColorSignals color = signals_of_light(product(Vec3f(color_factor(material)), tint));
        return signal == Signal::intensity ? color.intensity : color.opponency;
      }
      case Signal::emission: return grey_of_light(Vec3f(emission_factor(material)));
      case Signal::roughness: return static_cast<float>(material.roughness_factor);
      case Signal::metalness: return static_cast<float>(material.metallic_factor);
      case Signal::entropy:
      case Signal::normal_detail: return 0;
    }
    return 0;
  }

  VertexField at_vertices(Signal signal, const MeshState& state, const Adjacency& adjacency,
                          const std::vector<double>& areas) const {
    const std::vector<float>& values = state.values[static_cast<std::size_t>(signal)];
    VertexField field(values.empty() ? 0 : adjacency.vertex_count());
    parallel_for(context_, field.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const std::span<const std::uint32_t> corners = adjacency.corners(static_cast<std::uint32_t>(v));
        double area = 0;
        for (const std::uint32_t c : corners) area += areas[c / 3];
        // Around the first, so that a constant stays what it is.
        double first = 0, sum = 0, weight = 0;
        for (const std::uint32_t c : corners) {
          float x = values[c];
          if (std::isnan(x)) {
            const Part& part = state.mesh->parts[state.mesh->face_part[c / 3]];
            x = without_texture(signal, material_of(model_, part), state.colors.light(c));
          }
          if (weight == 0 && sum == 0) first = static_cast<double>(x);
          const double w = area > 0 ? areas[c / 3] : 1;
          sum += (static_cast<double>(x) - first) * w;
          weight += w;
        }
        if (weight > 0) field.values()[v] = static_cast<float>(first + sum / weight);
      }
    });
    return field;
  }

  SurfaceSignals at_vertices(const MeshState& state) const {
    const Surface surface = surface_of(*state.mesh);
    const Adjacency adjacency(surface, context_);
    std::vector<double> areas;
    areas.reserve(surface.triangles.size());
    for (const auto& [a, b, c] : surface.triangles) {
      areas.push_back(triangle_area(surface.position(a), surface.position(b), surface.position(c)));
    }
    const auto field = [&](Signal signal) { return at_vertices(signal, state, adjacency, areas); };
    SurfaceSignals result;
    result.intensity = field(Signal::intensity);
    result.opponency = field(Signal::opponency);
    result.entropy = field(Signal::entropy);
    result.emission = field(Signal::emission);
    result.roughness = field(Signal::roughness);
    result.metalness = field(Signal::metalness);
    result.normal_detail = field(Signal::normal_detail);
    result.texels = texels_at_vertices(state, areas);
    for (const VertexField* signal : {&result.intensity, &result.opponency, &result.entropy})
      result.textured = result.textured || varies(*signal, adjacency);
    return result;
  }

  static VertexField texels_at_vertices(const MeshState& state, const std::vector<double>& areas) {
    double area = 0, texels = 0;
    for (std::size_t f = 0; f < areas.size(); ++f) {
      if (std::isnan(state.texels[f])) continue;
      area += areas[f];
      texels += static_cast<double>(state.texels[f]);
    }
    const double density = area > 0 && texels > 0 ? texels / area : 1;
    std::vector<double> sums(state.mesh->vertex_count());
    for (std::size_t f = 0; f < areas.size(); ++f) {
      const double usual = density * areas[f];
      const double count = std::isnan(state.texels[f])
                               ? usual
                               : std::max(static_cast<double>(state.texels[f]), kLeastDensity * usual);
      for (const VertexId v : state.mesh->triangles[f]) sums[v.index()] += count / 3;
    }
    VertexField result(sums.size());
    for (std::size_t v = 0; v < sums.size(); ++v) result.values()[v] = static_cast<float>(sums[v]);
    return result;
  }

  static bool varies(const VertexField& field, const Adjacency& adjacency) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (std::uint32_t v = 0; v < field.size(); ++v) {
      if (adjacency.corners(v).empty()) continue;
      low = std::min(low, field.values()[v]);
      high = std::max(high, field.values()[v]);
    }
    return low < high;
  }

  const Model& model_;
  const SurfaceSignalOptions& options_;
  Context& context_;
  ImageDecoder decoder_;
  std::vector<MeshState> states_;
  std::map<TexelSource, std::vector<Use>> uses_;
};

}  // namespace

std::vector<SurfaceSignals> surface_signals(const Model& model, const SurfaceSignalOptions& options,
                                            Context& context) {
  std::vector<std::size_t> meshes;
  for (std::size_t i = 0; i < model.meshes.size(); ++i) meshes.push_back(i);
  return SignalMaker(model, meshes, options, context).run();
}

SurfaceSignals surface_signals(const Model& model, std::size_t mesh, const SurfaceSignalOptions& options,
                               Context& context) {
  return SignalMaker(model, std::span(&mesh, 1), options, context).run().front();
}

}  // namespace fovea
