#include "fovea/simplify/collapse_state.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/parallel.h"
#include "fovea/surface/local_order.h"

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

class Builder {
 public:
  Builder(std::span<const TriMesh* const> meshes, std::span<const double> scales,
          std::span<const VertexField* const> importance,
          std::span<const std::vector<FaceId>* const> left_out, double diagonal,
          const SimplifyOptions& options, const Context& context)
      : meshes_(meshes), importance_(importance), left_out_(left_out), options_(options), context_(context) {
    place_meshes(scales, diagonal);
  }

  CollapseState run() {
    make_connectivity();
    make_channels();
    make_locks();
    for (Channel& channel : state_.channels) {
      find_single_values(channel);
      if (channel.kind == ChannelKind::fitted) scale_channel(channel);
    }
    add_face_quadrics();
    add_edge_quadrics();
    price_components();
    return std::move(state_);
  }

 private:
  void place_meshes(std::span<const double> scales, double diagonal);
  void make_connectivity();
  void make_channels();
  void add_layer_channels(std::size_t m);
  void number_values(Channel& channel, std::size_t m, const AttributeLayer& layer);
  void add_morph_channel(std::size_t m);
  Channel& channel_for(const AttributeLayer& layer);
  void append_values(Channel& channel, std::size_t m, const std::vector<const AttributeLayer*>& layers,
                     const std::vector<std::uint32_t>& layer_indices);
  void reserve_records();
  void make_columns();
  void make_locks();
  FaceShape shape_of(std::size_t f) const;
  void find_single_values(Channel& channel) const;
  void scale_channel(Channel& channel) const;
  void add_face_quadrics();
  void add_face(std::uint32_t f, std::uint32_t m, std::size_t begin, std::size_t end, SlopeScratch& scratch);
  template <int Width>
  void add_slopes(Channel& channel, const FaceFrame& frame, std::size_t begin, std::size_t end,
                  SlopeScratch& scratch, CornerQuadrics& corners);
  void add_edge_quadrics();
  bool is_seam(std::uint32_t corner_a, std::uint32_t corner_b) const;
  void price_components();

  std::span<const FaceId> left_out(std::size_t m) const {
    return left_out_.empty() ? std::span<const FaceId>{} : std::span<const FaceId>(*left_out_[m]);
  }
  std::size_t face_count(std::size_t m) const { return meshes_[m]->face_count() - left_out(m).size(); }
  double weight_of(std::uint32_t v) const { return importance_weight_.empty() ? 1.0 : importance_weight_[v]; }
  ChannelKind kind_of(Semantic semantic) const;
  double option_weight(const Channel& channel) const;
  double steepness_limit(const Channel& channel, double scale) const;

  std::span<const TriMesh* const> meshes_;
  std::span<const VertexField* const> importance_;
  std::span<const std::vector<FaceId>* const> left_out_;
  const SimplifyOptions& options_;
  const Context& context_;
  CollapseState state_;
  std::vector<double> importance_weight_;  // [#V], empty if all are 1; 1 where locked
};

void Builder::place_meshes(std::span<const double> scales, double diagonal) {
  std::size_t vertices = 0, faces = 0;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    MeshSlot slot;
    slot.first_vertex = static_cast<std::uint32_t>(vertices);
    slot.first_face = static_cast<std::uint32_t>(faces);
    slot.center = bounds(*meshes_[m]).center();
    slot.scale = scales[m] / diagonal;
    state_.slots.push_back(slot);
    vertices += meshes_[m]->vertex_count();
    faces += face_count(m);
  }
  state_.mesh.vertices.reserve(vertices);
  state_.mesh.faces.reserve(faces);
  state_.mesh_vertex.reserve(vertices);
  state_.mesh_face.reserve(faces);
}

void Builder::make_connectivity() {
  CollapseMesh& all = state_.mesh;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshSlot& slot = state_.slots[m];
    const LocalOrder order = local_order(surface_of(*meshes_[m]));
    std::vector<std::uint32_t> vertex_of(order.vertices.size());
    for (const VertexId v : order.vertices) {
      vertex_of[v.index()] = static_cast<std::uint32_t>(all.vertices.size());
      all.vertices.emplace_back().position = Vec3f(slot.to_engine(meshes_[m]->positions[v.index()]));
    }
    for (const FaceId f : order.faces) {
      if (std::binary_search(left_out(m).begin(), left_out(m).end(), f)) continue;
      const auto& t = meshes_[m]->triangles[f.index()];
      all.faces.push_back({{vertex_of[t[0].index()], vertex_of[t[1].index()], vertex_of[t[2].index()]}, {}});
      state_.mesh_face.push_back(f);
    }
    state_.mesh_vertex.insert(state_.mesh_vertex.end(), order.vertices.begin(), order.vertices.end());
  }
  all.link();
}

ChannelKind Builder::kind_of(Semantic semantic) const {
  switch (semantic) {
    case Semantic::uv: return options_.uv_weight > 0 ? ChannelKind::fitted : ChannelKind::interpolated;
    case Semantic::normal:
      return options_.normal_weight > 0 ? ChannelKind::fitted : ChannelKind::interpolated;
    case Semantic::color: return options_.color_weight > 0 ? ChannelKind::fitted : ChannelKind::interpolated;
    case Semantic::tangent: return ChannelKind::interpolated;
    case Semantic::joints:
    case Semantic::weights: return ChannelKind::skin;
    case Semantic::custom: return ChannelKind::nearest;
  }
  return ChannelKind::nearest;
}

double Builder::option_weight(const Channel& channel) const {
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
double Builder::steepness_limit(const Channel& channel, double scale) const {
  if (channel.is_position_morph) return 4;
  if (channel.is_uv()) return 2 * kSlide * kSlide * option_weight(channel);
  const double steepness = 2 * scale / kGradientLength;
  return steepness * steepness;
}

Channel& Builder::channel_for(const AttributeLayer& layer) {
  const bool skin = kind_of(layer.semantic) == ChannelKind::skin;
  for (Channel& c : state_.channels) {
    if (skin ? c.kind == ChannelKind::skin
             : !c.is_position_morph && c.semantic == layer.semantic && c.set == layer.set &&
                   c.name == layer.name) {
      return c;
    }
  }
  Channel channel;
  channel.kind = kind_of(layer.semantic);
  channel.semantic = layer.semantic;
  channel.set = skin ? 0 : layer.set;
  channel.name = layer.name;
  state_.channels.push_back(std::move(channel));
  return state_.channels.back();
}

void Builder::make_channels() {
  // First the shape of each channel (values need their final width), then its contents.
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    int skin_width = 0;
    for (const AttributeLayer& layer : meshes_[m]->layers) {
      Channel& channel = channel_for(layer);
      int width = layer.width * (1 + static_cast<int>(layer.morphs.size()));
      if (channel.kind == ChannelKind::skin) width = skin_width += layer.width;
      channel.width = std::max(channel.width, width);
      if (channel.kind == ChannelKind::fitted) channel.fit_width = std::max(channel.fit_width, layer.width);
    }
  }
  int targets = 0;
  for (const TriMesh* mesh : meshes_) targets = std::max(targets, static_cast<int>(mesh->target_count()));
  if (targets > 0) {
    Channel channel;
    channel.is_position_morph = true;
    channel.width = channel.fit_width = 3 * targets;
    state_.channels.push_back(std::move(channel));
  }
  for (Channel& channel : state_.channels) {
    if (channel.kind == ChannelKind::fitted) channel.quadric_size = attribute_stride(channel.fit_width);
    channel.stride = channel.quadric_size + static_cast<std::size_t>(channel.width);
    channel.slices.resize(meshes_.size());
    channel.scale.assign(meshes_.size(), 1.0);
  }
  make_columns();
  reserve_records();
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    add_layer_channels(m);
    add_morph_channel(m);
  }
}

/// Room for the values of all meshes at once: what grows leaves holes in memory.
void Builder::reserve_records() {
  for (Channel& channel : state_.channels) {
    std::size_t count = 0;
    for (const TriMesh* mesh : meshes_) {
      if (channel.is_position_morph) count += mesh->vertex_count();
      for (const AttributeLayer& layer : mesh->layers) {
        if (&channel_for(layer) != &channel) continue;
        count += layer.size();
        if (channel.kind == ChannelKind::skin) break;  // its layers share one map
      }
    }
    channel.records.reserve(count * channel.stride);
    channel.layer_value.reserve(count);
  }
}

/// Room for what the channels have for corners and vertices; nothing to begin with.
void Builder::make_columns() {
  const std::size_t channels = state_.channels.size(), corners = 3 * state_.mesh.faces.size();
  state_.columns.assign(channels * (corners + state_.mesh.vertices.size()), kInvalid);
  for (std::size_t i = 0; i < channels; ++i) {
    state_.channels[i].corner_value = Column(state_.columns.data() + i, channels);
    state_.channels[i].single = Column(state_.columns.data() + channels * corners + i, channels);
  }
}

void Builder::add_layer_channels(std::size_t m) {
  const TriMesh& mesh = *meshes_[m];
  std::vector<const AttributeLayer*> skin;
  std::vector<std::uint32_t> skin_indices;
  for (std::uint32_t l = 0; l < mesh.layers.size(); ++l) {
    const AttributeLayer& layer = mesh.layers[l];
    if (kind_of(layer.semantic) == ChannelKind::skin) {
      skin.push_back(&layer);
      skin_indices.push_back(l);
    } else {
      append_values(channel_for(layer), m, {&layer}, {l});
    }
  }
  if (!skin.empty()) append_values(channel_for(*skin.front()), m, skin, skin_indices);
}

/// Appends the values and corner map of layers that share one map as one run of the channel.
void Builder::append_values(Channel& channel, std::size_t m, const std::vector<const AttributeLayer*>& layers,
                            const std::vector<std::uint32_t>& layer_indices) {
  int offset = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const int width = layers[i]->width * (1 + static_cast<int>(layers[i]->morphs.size()));
    channel.slices[m].push_back({layer_indices[i], offset, width, layers[i]->semantic});
    offset += width;
  }
  const std::size_t first = channel.layer_value.size();
  number_values(channel, m, *layers.front());
  channel.records.resize(channel.layer_value.size() * channel.stride, 0.0f);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const AttributeLayer& layer = *layers[i];
    const auto width = static_cast<std::size_t>(layer.width);
    for (std::size_t value = first; value < channel.layer_value.size(); ++value) {
      const ValueId id = channel.layer_value[value];
      float* out = channel.value(static_cast<std::uint32_t>(value)) + channel.slices[m][i].offset;
      out = std::copy_n(layer.value(id), width, out);
      for (const auto& morph : layer.morphs) {
        if (!morph.empty()) std::copy_n(morph.data() + id.index() * width, width, out);
        out += width;
      }
    }
  }
}

/// Numbers the values of a layer of mesh m in the order in which its triangles use them.
void Builder::number_values(Channel& channel, std::size_t m, const AttributeLayer& layer) {
  std::vector<std::uint32_t> number(layer.size(), kInvalid);
  const std::size_t first_face = state_.slots[m].first_face;
  for (std::size_t f = first_face; f < first_face + face_count(m); ++f) {
    for (int k = 0; k < 3; ++k) {
      const ValueId id = layer.corner_value[corner(state_.mesh_face[f], k).index()];
      if (!id.valid()) continue;
      std::uint32_t& n = number[id.index()];
      if (n == kInvalid) {
        n = static_cast<std::uint32_t>(channel.layer_value.size());
        channel.layer_value.push_back(id);
      }
      channel.corner_value[3 * f + static_cast<std::size_t>(k)] = n;
    }
  }
}

/// Position morphs are the only value of their vertex.
void Builder::add_morph_channel(std::size_t m) {
  const TriMesh& mesh = *meshes_[m];
  if (mesh.target_count() == 0) return;
  Channel& channel = state_.channels.back();
  const MeshSlot& slot = state_.slots[m];
  const std::size_t first = channel.layer_value.size();
  channel.slices[m].push_back({kInvalid, 0, 3 * static_cast<int>(mesh.target_count()), Semantic::custom});
  channel.records.resize((first + mesh.vertex_count()) * channel.stride, 0.0f);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const VertexId id = state_.mesh_vertex[slot.first_vertex + v];
    channel.layer_value.push_back(ValueId{id.index()});
    float* out = channel.value(static_cast<std::uint32_t>(first + v));
    for (const auto& morph : mesh.position_morphs) {
      *out++ = morph[id.index()].x;
      *out++ = morph[id.index()].y;
      *out++ = morph[id.index()].z;
    }
  }
  for (std::size_t c = 3 * std::size_t{slot.first_face}; c < 3 * (slot.first_face + face_count(m)); ++c) {
    const std::uint32_t v = state_.mesh.vertex(static_cast<std::uint32_t>(c));
    channel.corner_value[c] = static_cast<std::uint32_t>(first) + v - slot.first_vertex;
  }
}

void Builder::make_locks() {
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    if (importance_.empty() || importance_[m] == nullptr || importance_[m]->empty()) continue;
    if (importance_weight_.empty()) importance_weight_.assign(state_.mesh.vertices.size(), 1.0);
    for (std::size_t v = 0; v < importance_[m]->size(); ++v) {
      const std::size_t at = state_.slots[m].first_vertex + v;
      const float w = importance_[m]->values()[state_.mesh_vertex[at].index()];
      if (std::isinf(w)) {
        state_.mesh.vertices[at].locked = 1;
      } else {
        importance_weight_[at] = w;
      }
    }
  }
  if (!options_.lock_boundary) return;
  for (const CollapseEdge& edge : state_.mesh.edges) {
    if (edge.face_count() != 1) continue;
    for (const std::uint32_t v : edge.ends) state_.mesh.vertices[v].locked = 1;
  }
}

FaceShape Builder::shape_of(std::size_t f) const {
  const auto& t = state_.mesh.faces[f].vertex;
  const Vec3d p = state_.mesh.position(t[0]);
  const Vec3d n = cross(state_.mesh.position(t[1]) - p, state_.mesh.position(t[2]) - p);
  const double l = length(n);
  return {l > 0 ? n / l : Vec3d{}, 0.5 * l};
}

void Builder::find_single_values(Channel& channel) const {
  for (std::uint32_t c = 0; c < 3 * state_.mesh.faces.size(); ++c) {
    const std::uint32_t value = channel.corner_value[c];
    if (value == kInvalid) continue;
    std::uint32_t& single = channel.single[state_.mesh.vertex(c)];
    single = single == kInvalid || single == value ? value : Channel::kMany;
  }
}

/// From the layer's units to lengths. Texture coordinates: by the mean stretch of the mesh, so that
/// the same slide on the surface is the same error, whatever the texture's resolution.
void Builder::scale_channel(Channel& channel) const {
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
      for (std::size_t i = 0; i < face_count(m); ++i) {
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
void Builder::add_face_quadrics() {
  CollapseMesh& mesh = state_.mesh;
  constexpr int kMostRanges = 8;
  const auto ranges = static_cast<std::size_t>(std::min(context_.thread_count(), kMostRanges));
  parallel_for(context_, mesh.vertices.size(), mesh.vertices.size() / ranges + 1,
               [&](std::size_t begin, std::size_t end) {
                 SlopeScratch scratch;
                 std::uint32_t f = 0;
                 for (std::uint32_t m = 0; m < meshes_.size(); ++m) {
                   for (std::size_t k = 0; k < face_count(m); ++k, ++f) {
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
void Builder::add_face(std::uint32_t f, std::uint32_t m, std::size_t begin, std::size_t end,
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
void Builder::add_slopes(Channel& channel, const FaceFrame& frame, std::size_t begin, std::size_t end,
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
    if (importance_weight_.empty()) {
      for (std::size_t i = 0; i < stride; ++i) value[i] += rounded[i];
      continue;
    }
    const double weight = importance_weight_[vertices[k]];
    for (std::size_t i = 0; i < stride; ++i) value[i] += static_cast<float>(weight * slopes[i]);
  }
}

/// Whether two faces on one edge, at corners whose edge it is, differ in texture coordinates or part.
bool Builder::is_seam(std::uint32_t a, std::uint32_t b) const {
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
void Builder::add_edge_quadrics() {
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
void Builder::price_components() {
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

std::uint32_t CollapseState::find_slot(std::uint32_t item, std::uint32_t MeshSlot::*first) const {
  // All the same for a few: nothing foretells which half is right.
  constexpr std::size_t kFew = 8;
  const auto is_after = [&](std::uint32_t x, const MeshSlot& slot) { return x < slot.*first; };
  if (slots.size() > kFew) {
    const auto after = std::upper_bound(slots.begin(), slots.end(), item, is_after);
    return static_cast<std::uint32_t>(after - slots.begin()) - 1;
  }
  std::uint32_t slot = 0;
  for (std::size_t i = 1; i < slots.size(); ++i) slot += !is_after(item, slots[i]);
  return slot;
}

CollapseState make_collapse_state(std::span<const TriMesh* const> meshes, std::span<const double> scales,
                                  std::span<const VertexField* const> importance,
                                  std::span<const std::vector<FaceId>* const> left_out, double diagonal,
                                  const SimplifyOptions& options, const Context& context) {
  return Builder(meshes, scales, importance, left_out, diagonal, options, context).run();
}

}  // namespace fovea
