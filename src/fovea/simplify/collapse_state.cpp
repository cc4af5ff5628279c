#include "fovea/simplify/collapse_state.h"

#include <algorithm>
#include <cmath>

#include "fovea/simplify/first_quadrics.h"
#include "fovea/surface/local_order.h"

namespace fovea {

namespace {

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
    for (Channel& channel : state_.channels) find_single_values(channel);
    add_first_quadrics(state_, meshes_, importance_weight_, options_, context_);
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
  void find_single_values(Channel& channel) const;

  std::span<const FaceId> left_out(std::size_t m) const {
    return left_out_.empty() ? std::span<const FaceId>{} : std::span<const FaceId>(*left_out_[m]);
  }
  std::size_t face_count(std::size_t m) const { return meshes_[m]->face_count() - left_out(m).size(); }
  ChannelKind kind_of(Semantic semantic) const;

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

void Builder::find_single_values(Channel& channel) const {
  for (std::uint32_t c = 0; c < 3 * state_.mesh.faces.size(); ++c) {
    const std::uint32_t value = channel.corner_value[c];
    if (value == kInvalid) continue;
    std::uint32_t& single = channel.single[state_.mesh.vertex(c)];
    single = single == kInvalid || single == value ? value : Channel::kMany;
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
