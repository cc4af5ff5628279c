#include "fovea/simplify/first_quadrics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

// Lengths are in units of the scene's diagonal.

/// A texture that slides by some length counts as a surface that moves by this fraction of it: slides
/// hide in most textures, while shape shows in outline and shading.
constexpr double kSlide = 0.018;
/// A normal that turns by one radian counts as a surface that moves by this much.
constexpr double kNormalLength = 0.009;
/// A colour that changes from black to white counts as a surface that moves by this much.
constexpr double kColorLength = 0.02;
/// Attributes that change by more than their range over this length do not change faster for the
/// engine: beyond tiny triangles their gradients say nothing.
constexpr double kGradientLength = 0.01;
/// Pull towards the original vertices, as a fraction of the surface's own weight: keeps optimal
/// positions defined on flat regions and orders their edges by length.
constexpr double kRegularization = 1e-4;
/// Weights of the planes through boundary and seam edges for an option value of 1.
constexpr double kBoundaryWeight = 1;
constexpr double kSeamWeight = 0.3;
/// Weight of a component that vanishes against a surface of its area that moves by its radius.
constexpr double kVanishWeight = 1;

/// What is found anew each time that it is needed, rather than kept: memory is scarcer than time.
struct FaceShape {
  Vec3d normal;  ///< Unit, or zero.
  double area;
};

/// A face while its quadrics are added.
struct FaceFrame {
  std::uint32_t face, mesh;
  double weight;  ///< For each of its corners.
  Vec3d origin;   ///< Its first corner.
  TriangleGradient gradient;
};

/// Room for the slopes of attributes of any width.
struct SlopeScratch {
  std::vector<double> slopes;
  std::vector<float> rounded;
};

/// What a face adds to its corners, to each as a function of the way from there: the squares are the same for
/// all.
struct CornerQuadrics {
  Quadric squares;
  struct Rest {
    Vec3d b;
    double c = 0;
  };
  std::array<Rest, 3> rest;

  /// Adds w · (g·way + d)² with the corners' own d.
  void add_linear(Vec3d g, std::array<double, 3> d, double w) {
    squares.add_linear(g, 0, w);
    for (std::size_t k = 0; k < 3; ++k) {
      rest[k].b += w * d[k] * g;
      rest[k].c += w * d[k] * d[k];
    }
  }
  Quadric at(std::size_t k) const {
    Quadric q = squares;
    q.bx = rest[k].b.x, q.by = rest[k].b.y, q.bz = rest[k].b.z;
    q.c = rest[k].c;
    return q;
  }
};

class FirstQuadrics {
 public:
  FirstQuadrics(CollapseState& state, std::span<const TriMesh* const> meshes,
                std::span<const double> importance, const SimplifyOptions& options, const Context& context)
      : state_(state), meshes_(meshes), importance_(importance), options_(options), context_(context) {}

  void run() {
    for (Channel& channel : state_.channels) {
      if (channel.kind == ChannelKind::fitted) scale_channel(channel);
    }
    add_face_quadrics();
    add_edge_quadrics();
    price_components();
  }

 private:
  double option_weight(const Channel& channel) const;
  double steepness_limit(const Channel& channel, double scale) const;
  double weight_of(std::uint32_t v) const { return importance_.empty() ? 1.0 : importance_[v]; }
  FaceShape shape_of(std::size_t f) const;
  void scale_channel(Channel& channel) const;
  void add_face_quadrics();
  void add_face(std::uint32_t f, std::uint32_t m, std::size_t begin, std::size_t end, SlopeScratch& scratch);
  template <int Width>
  void add_slopes(Channel& channel, const FaceFrame& frame, std::size_t begin, std::size_t end,
                  SlopeScratch& scratch, CornerQuadrics& corners);
  void add_edge_quadrics();
  bool is_seam(std::uint32_t corner_a, std::uint32_t corner_b) const;
  void price_components();

  CollapseState& state_;
  std::span<const TriMesh* const> meshes_;
  std::span<const double> importance_;  // [#V], empty if all are 1
  const SimplifyOptions& options_;
  const Context& context_;
};

double FirstQuadrics::option_weight(const Channel& channel) const {
  if (channel.is_position_morph) return 1;
  switch (channel.semantic) {
    case Semantic::uv: return options_.uv_weight;
    case Semantic::normal: return options_.normal_weight;
    case Semantic::color: return options_.color_weight;
    default: return 0;
  }
}

/// Squared gradient beyond which an attribute's error is damped. For textures that of the mesh's mean
/// stretch: where texels are crowded a slide is no worse than it looks on the surface.
double FirstQuadrics::steepness_limit(const Channel& channel, double scale) const {
  if (channel.is_position_morph) return 4;
  if (channel.is_uv()) return 2 * kSlide * kSlide * option_weight(channel);
  const double steepness = 2 * scale / kGradientLength;
  return steepness * steepness;
}

FaceShape FirstQuadrics::shape_of(std::size_t f) const {
  const auto& t = state_.mesh.faces[f].vertex;
  const Vec3d p = state_.mesh.position(t[0]);
  const Vec3d n = cross(state_.mesh.position(t[1]) - p, state_.mesh.position(t[2]) - p);
  const double l = length(n);
  return {l > 0 ? n / l : Vec3d{}, 0.5 * l};
}

/// From the layer's units to lengths. Texture coordinates: by the mean stretch of the mesh, so that
/// the same slide on the surface is the same error, whatever the texture's resolution.
void FirstQuadrics::scale_channel(Channel& channel) const {
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const double weight = std::sqrt(option_weight(channel));
    double length = 1;
    if (channel.is_position_morph) {
      length = state_.slots[m].scale;
    } else if (channel.semantic == Semantic::normal) {
      length = kNormalLength;
    } else if (channel.semantic == Semantic::color) {
      length = kColorLength;
    } else if (channel.is_uv()) {
      double area = 0, area_uv = 0;
      for (std::size_t i = 0; i < state_.face_count(m); ++i) {
        const std::size_t f = state_.slots[m].first_face + i;
        if (channel.corner_value[3 * f] == kInvalid) continue;
        const auto uv = [&](std::size_t k) {
          const float* x = channel.value(channel.corner_value[3 * f + k]);
          return Vec2d{x[0], x[1]};
        };
        area += shape_of(f).area;
        area_uv += 0.5 * std::abs(cross(uv(1) - uv(0), uv(2) - uv(0)));
      }
      length = area_uv > 0 ? kSlide * std::sqrt(area / area_uv) : 0;
    }
    channel.scale[m] = weight * length;
  }
}

/// Every face adds its plane and the slopes of its attributes to its corners. Each thread walks all
/// faces for a range of vertices of its own, so that sums come out the same for any number of threads.
void FirstQuadrics::add_face_quadrics() {
  CollapseMesh& mesh = state_.mesh;
  constexpr int kMostRanges = 8;
  const auto ranges = static_cast<std::size_t>(std::min(context_.thread_count(), kMostRanges));
  parallel_for(context_, mesh.vertices.size(), mesh.vertices.size() / ranges + 1,
               [&](std::size_t begin, std::size_t end) {
                 SlopeScratch scratch;
                 std::uint32_t f = 0;
                 for (std::uint32_t m = 0; m < meshes_.size(); ++m) {
                   for (std::size_t k = 0; k < state_.face_count(m); ++k, ++f) {
                     const auto& t = mesh.faces[f].vertex;
                     const auto inside = [&](std::uint32_t v) { return v >= begin && v < end; };
                     if (inside(t[0]) || inside(t[1]) || inside(t[2])) add_face(f, m, begin, end, scratch);
                   }
                 }
                 for (std::size_t v = begin; v < end; ++v) {
                   Quadric pull;
                   pull.add_point({},
                                  kRegularization * static_cast<double>(mesh.vertices[v].quadric.weight()));
                   mesh.vertices[v].quadric.add_scaled(pull, weight_of(static_cast<std::uint32_t>(v)));
                 }
               });
}

/// Adds face f of mesh m to those of its corners whose vertices are in [begin, end).
void FirstQuadrics::add_face(std::uint32_t f, std::uint32_t m, std::size_t begin, std::size_t end,
                             SlopeScratch& scratch) {
  CollapseMesh& mesh = state_.mesh;
  const auto& t = mesh.faces[f].vertex;
  const Vec3d p0 = mesh.position(t[0]);
  const auto [normal, area] = shape_of(f);
  CornerQuadrics corners;
  corners.squares.weight = area / 3;
  corners.squares.add_linear(normal, 0, area / 3);
  if (area > 1e-16) {
    const FaceFrame frame{
        f, m, area / 3, p0,
        TriangleGradient(mesh.position(t[1]) - p0, mesh.position(t[2]) - p0, normal, 2 * area)};
    for (Channel& channel : state_.channels) {
      if (channel.kind != ChannelKind::fitted || channel.corner_value[3 * f] == kInvalid) continue;
      switch (channel.fit_width) {
        case 2: add_slopes<2>(channel, frame, begin, end, scratch, corners); break;
        case 3: add_slopes<3>(channel, frame, begin, end, scratch, corners); break;
        default: add_slopes<0>(channel, frame, begin, end, scratch, corners);
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = t[k];
    if (v >= begin && v < end) mesh.vertices[v].quadric.add_scaled(corners.at(k), weight_of(v));
  }
}

/// Adds how a channel runs over a face, as linear functions in lengths, to the quadrics of its corners and of
/// its values. What is too steep is damped. `Width` is what fits the channel, or 0 for any.
template <int Width>
void FirstQuadrics::add_slopes(Channel& channel, const FaceFrame& frame, std::size_t begin, std::size_t end,
                               SlopeScratch& scratch, CornerQuadrics& corners) {
  const int width = Width > 0 ? Width : channel.fit_width;
  const std::size_t stride = attribute_stride(width);
  // In the layout of attribute quadrics, and the same rounded:
  std::array<double, attribute_stride(Width)> slopes_here;
  std::array<float, attribute_stride(Width)> rounded_here;
  if constexpr (Width == 0) {
    scratch.slopes.resize(std::max(scratch.slopes.size(), stride));
    scratch.rounded.resize(scratch.slopes.size());
  }
  double* const slopes = Width > 0 ? slopes_here.data() : scratch.slopes.data();
  float* const rounded = Width > 0 ? rounded_here.data() : scratch.rounded.data();
  const double scale = channel.scale[frame.mesh];
  std::array<const float*, 3> s;
  for (std::size_t k = 0; k < 3; ++k) s[k] = channel.value(channel.corner_value[3 * frame.face + k]);
  double steepness = 0;
  for (int k = 0; k < width; ++k) {
    const Vec3d g = frame.gradient(s[0][k], s[1][k], s[2][k]) * scale;
    slopes[4 * k] = g.x;
    slopes[4 * k + 1] = g.y;
    slopes[4 * k + 2] = g.z;
    slopes[4 * k + 3] = scale * s[0][k] - dot(g, frame.origin);
    steepness += dot(g, g);
  }
  const double limit = steepness_limit(channel, scale);
  const double share = frame.weight * (steepness > limit ? limit / steepness : 1);
  for (int k = 0; k < width; ++k) {
    const Vec3d g{slopes[4 * k], slopes[4 * k + 1], slopes[4 * k + 2]};
    corners.add_linear(g, {scale * s[0][k], scale * s[1][k], scale * s[2][k]}, share);
  }
  slopes[4 * width] = 1;
  for (std::size_t i = 0; i < stride; ++i) {
    slopes[i] *= share;
    rounded[i] = static_cast<float>(slopes[i]);
  }
  const std::array<std::uint32_t, 3>& vertices = state_.mesh.faces[frame.face].vertex;
  for (std::size_t k = 0; k < 3; ++k) {
    if (vertices[k] < begin || vertices[k] >= end) continue;
    float* const value = channel.value_quadric(channel.corner_value[3 * frame.face + k]);
    if (importance_.empty()) {
      for (std::size_t i = 0; i < stride; ++i) value[i] += rounded[i];
      continue;
    }
    const double weight = importance_[vertices[k]];
    for (std::size_t i = 0; i < stride; ++i) value[i] += static_cast<float>(weight * slopes[i]);
  }
}

/// Whether two faces on one edge, at corners whose edge it is, differ in texture coordinates or part.
bool FirstQuadrics::is_seam(std::uint32_t a, std::uint32_t b) const {
  // The corners at the two ends: a runs from v to w; b the other way, or the same in a twisted mesh.
  const CollapseMesh& mesh = state_.mesh;
  const bool same_direction = mesh.vertex(a) == mesh.vertex(b);
  const std::uint32_t b_at_v = same_direction ? b : CollapseMesh::next(b);
  const std::uint32_t b_at_w = same_direction ? CollapseMesh::next(b) : b;
  for (const Channel& channel : state_.channels) {
    if (!channel.is_uv()) continue;
    if (channel.corner_value[a] != channel.corner_value[b_at_v]) return true;
    if (channel.corner_value[CollapseMesh::next(a)] != channel.corner_value[b_at_w]) return true;
  }
  const std::uint32_t m = state_.slot_of_face(a / 3);
  const auto part = [&](std::uint32_t c) { return meshes_[m]->face_part[state_.mesh_face[c / 3].index()]; };
  return part(a) != part(b);
}

/// Planes through boundary and seam edges, upright on their faces, hold the curves in place.
void FirstQuadrics::add_edge_quadrics() {
  const CollapseMesh& mesh = state_.mesh;
  const auto hold = [&](std::uint32_t c, double weight) {
    const std::uint32_t v = mesh.vertex(c), w = mesh.vertex(CollapseMesh::next(c));
    const Vec3d edge = state_.mesh.position(w) - state_.mesh.position(v);
    const Vec3d upright = normalized(cross(shape_of(c / 3).normal, edge));
    Quadric q;  // around both ends: the plane goes through them
    q.weight = 0.5 * weight * dot(edge, edge);
    q.add_linear(upright, 0, q.weight);
    for (const std::uint32_t end : {v, w}) {
      state_.mesh.vertices[end].quadric.add_scaled(q, weight_of(end));
    }
  };
  for (std::uint32_t c = 0; c < 3 * mesh.faces.size(); ++c) {
    const CollapseEdge& edge = mesh.edges[mesh.edge(c)];
    if (edge.face_count() == 1) {
      hold(c, kBoundaryWeight * options_.boundary_weight);
    } else if (edge.face_count() == 2) {
      const auto [first, second] = std::minmax(edge.half_edges[0], edge.half_edges[1]);
      if (c == second && is_seam(first, second)) {
        hold(first, kSeamWeight * options_.seam_weight);
        hold(second, kSeamWeight * options_.seam_weight);
      }
    }
  }
}

/// A component that vanishes is a surface that moves away by its own size.
void FirstQuadrics::price_components() {
  state_.components = find_components(state_.mesh);
  state_.vanish.resize(state_.components.count());
  if (state_.vanish.size() < 2) {  // the last one never vanishes
    state_.components.faces = std::vector<std::uint32_t>();
    return;
  }
  for (std::size_t i = 0; i < state_.vanish.size(); ++i) {
    Box box;
    double weight = 0;
    for (std::uint32_t k = state_.components.first[i]; k < state_.components.first[i + 1]; ++k) {
      const std::uint32_t f = state_.components.faces[k];
      const double area = shape_of(f).area;
      for (const std::uint32_t v : state_.mesh.faces[f].vertex) {
        box.add(state_.mesh.position(v));
        weight += area / 3 * weight_of(v);
      }
    }
    const double radius = 0.5 * box.diagonal();
    state_.vanish[i] = {kVanishWeight * weight * radius * radius, radius};
  }
}

}  // namespace

void add_first_quadrics(CollapseState& state, std::span<const TriMesh* const> meshes,
                        std::span<const double> importance, const SimplifyOptions& options,
                        const Context& context) {
  FirstQuadrics(state, meshes, importance, options, context).run();
}

}  // namespace fovea
