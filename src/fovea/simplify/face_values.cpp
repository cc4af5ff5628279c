#include "fovea/simplify/face_values.h"

#include <algorithm>
#include <cmath>

#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/render/fragment_lists.h"

namespace fovea {

namespace {

/// Grey without coverage: what pixels without a surface have.
constexpr PackedColor kBackgroundColor = 0x00808080;
/// Of blended surfaces what lets more light through than this counts as a hole.
constexpr float kBlendCutoff = 0.5f;

int find_channel(const CollapseState& state, Semantic semantic, int set) {
  for (std::size_t i = 0; i < state.channels.size(); ++i) {
    const Channel& channel = state.channels[i];
    if (!channel.is_position_morph && channel.semantic == semantic && channel.set == set)
      return static_cast<int>(i);
  }
  return -1;
}

using Plane = CornerPlanes::Plane;

/// A number of a plane at pixels, in the order of operations that planes have.
FOVEA_WIDE void plane_at(const Plane& plane, int number, const WideFloats& __restrict x,
                         const WideFloats& __restrict y, WideFloats& __restrict out) {
  const float at_0 = plane.at_0[number], dx = plane.dx[number], dy = plane.dy[number];
  for (std::size_t i = 0; i < kWide; ++i) out[i] = at_0 + dx * x[i] + dy * y[i];
}

FOVEA_WIDE void scale(const WideFloats& __restrict by, WideFloats& __restrict numbers) {
  for (std::size_t i = 0; i < kWide; ++i) numbers[i] *= by[i];
}

FOVEA_WIDE void invert(WideFloats& __restrict numbers) {
  for (float& x : numbers) x = 1 / x;
}

/// A channel of colours, as numbers.
FOVEA_WIDE void unpack(const WideWords& __restrict colors, int channel, WideFloats& __restrict out) {
  for (std::size_t i = 0; i < kWide; ++i)
    out[i] = static_cast<float>(static_cast<std::int32_t>(colors[i] >> (8 * channel) & 255));
}

/// Display values under light, nearly: the amount of light is the square.
FOVEA_WIDE void light_channel(const WideFloats& __restrict tinted, const WideFloats& __restrict white,
                              WideFloats& __restrict display) {
  for (std::size_t i = 0; i < kWide; ++i)
    display[i] = std::sqrt(display[i] * display[i] * tinted[i] + white[i] * (255.0f * 255.0f));
}

/// Rounds a channel and puts it into colours; what is no number is full.
FOVEA_WIDE void pack(const WideFloats& __restrict display, int channel, WideWords& __restrict colors) {
  for (std::size_t i = 0; i < kWide; ++i) {
    const float x = display[i] + 0.5f;
    const auto whole = static_cast<std::int32_t>(x < 255 ? (x > 0 ? x : 0.0f) : 255.0f);
    colors[i] |= static_cast<std::uint32_t>(whole) << (8 * channel);
  }
}

/// Colours are opaque from here on, or holes.
FOVEA_WIDE void cut(const WideWords& __restrict alpha_of, std::uint32_t cutoff,
                    WideWords& __restrict colors) {
  for (std::size_t i = 0; i < kWide; ++i)
    colors[i] = (alpha_of[i] >> 24) < cutoff ? FragmentLists::kHole : colors[i] | 0xFF000000;
}

}  // namespace

FaceValues::FaceValues(const CollapseState& state, const ShownSurface& shown, const RenderScene& scene,
                       PixelContent content, int view_size, const ModelRegions* regions,
                       std::span<const std::size_t> mesh_index, const Context& context)
    : state_(state),
      shown_(shown),
      content_(content),
      view_size_(view_size),
      regions_(regions),
      mesh_index_(mesh_index.begin(), mesh_index.end()),
      normal_channel_(find_channel(state, Semantic::normal, 0)),
      color_channel_(find_channel(state, Semantic::color, 0)) {
  for (const SceneMaterial& material : scene.materials) {
    MaterialLook& look = materials_.emplace_back();
    look.color = packed(material.base_color);
    look.unlit = material.unlit;
    if (material.alpha_mode == AlphaMode::opaque) look.color |= 0xFF000000;
    const float cutoff = material.alpha_mode == AlphaMode::mask    ? material.alpha_cutoff
                         : material.alpha_mode == AlphaMode::blend ? kBlendCutoff
                                                                   : 0;
    look.cutoff = static_cast<std::uint32_t>(std::clamp(cutoff, 0.0f, 1.0f) * 255);
    if (!material.base_color_texture) continue;
    const SceneTexture& texture = *material.base_color_texture;
    look.channel = find_channel(state, Semantic::uv, texture.uv_set);
    if (look.channel < 0) continue;
    look.texture = add_texture(scene, texture, material.base_color);
    look.matrix = texture.matrix;
  }
  if (content == PixelContent::lit) make_lights(scene, context);
}

/// Materials shine by their mean: maps of metalness and roughness count as their average.
void FaceValues::make_lights(const RenderScene& scene, const Context& context) {
  constexpr float kSteps = 8;
  for (std::size_t m = 0; m < materials_.size(); ++m) {
    const SceneMaterial& material = scene.materials[m];
    float metallic = material.metallic, roughness = material.roughness;
    if (material.metallic_roughness_texture) {
      const MipMap& map =
          *scene.images[static_cast<std::size_t>(material.metallic_roughness_texture->image)].map;
      if (map.level_count() > 0) {
        const Rgba mean = map.texel(map.level_count() - 1, 0, 0);
        metallic *= mean.b;
        roughness *= mean.g;
      }
    }
    const auto step = [](float x) { return static_cast<int>(std::clamp(x, 0.0f, 1.0f) * kSteps + 0.5f); };
    const Finish finish{step(metallic), step(roughness)};
    auto known = std::find(finishes_.begin(), finishes_.end(), finish);
    if (known == finishes_.end()) known = finishes_.insert(known, finish);
    materials_[m].finish = static_cast<std::size_t>(known - finishes_.begin());
  }
  lights_.resize(shown_.view_count() * finishes_.size());
  parallel_for(context, shown_.view_count(), 1, [&](std::size_t view, std::size_t) {
    for (std::size_t i = 0; i < finishes_.size(); ++i) {
      lights_[view * finishes_.size() + i] =
          LightTable(static_cast<float>(finishes_[i].metallic) / kSteps,
                     static_cast<float>(finishes_[i].roughness) / kSteps, Vec3f(shown_.view(view).back));
    }
  });
}

/// The texture seen through a factor; materials share it.
int FaceValues::add_texture(const RenderScene& scene, const SceneTexture& texture, Rgba factor) {
  const MipMap& map = *scene.images[static_cast<std::size_t>(texture.image)].map;
  if (map.level_count() == 0) return -1;
  const TextureKey key{texture.image, factor, texture.sampler.wrap_u, texture.sampler.wrap_v};
  const auto known = std::find(keys_.begin(), keys_.end(), key);
  if (known != keys_.end()) return static_cast<int>(known - keys_.begin());
  keys_.push_back(key);
  // A chart rarely fills a view with less than a quarter of its image's side.
  textures_.emplace_back(map, factor, texture.sampler, 4 * view_size_);
  return static_cast<int>(textures_.size()) - 1;
}

std::uint32_t FaceValues::background() const {
  return content_ == PixelContent::color || content_ == PixelContent::lit ? kBackgroundColor : 0;
}

std::size_t FaceValues::value_count() const {
  return content_ == PixelContent::region ? regions_->count() : shown_.face_count() + std::size_t{1};
}

FaceLook FaceValues::look(const ShownInstance& showing, std::uint32_t f,
                          const PlannedCollapse* planned) const {
  FaceLook look;
  look.material = shown_.material(f);
  look.number = shown_.shown_face(showing, f) + 1;
  if (content_ == PixelContent::face) return look;
  const MaterialLook& material = materials_[look.material];
  look.color = material.color;
  if (content_ == PixelContent::region) {
    set_region(look, showing.slot, f, planned);
    if (!has_holes(f)) return look;
  }
  std::array<const float*, 3> values;
  if (material.texture >= 0 && corner_values(material.channel, f, planned, values)) {
    look.texture = &textures_[static_cast<std::size_t>(material.texture)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2f uv = material.matrix({values[k][0], values[k][1]});
      look.uv[k] = Float4{uv.x, uv.y, 0, 0};
    }
    const Float4 a = look.uv[1] - look.uv[0], b = look.uv[2] - look.uv[0];
    look.texel_area =
        std::abs(a[0] * b[1] - a[1] * b[0]) * look.texture->full_width() * look.texture->full_height();
  }
  if (corner_values(color_channel_, f, planned, values)) {
    look.is_tinted = true;
    for (std::size_t k = 0; k < 3; ++k) {
      look.tint[k] =
          Float4{linear_to_srgb(values[k][0]), linear_to_srgb(values[k][1]), linear_to_srgb(values[k][2]), 0};
    }
  }
  if (content_ == PixelContent::lit && !material.unlit) set_normals(look, showing, f, planned);
  return look;
}

void FaceValues::set_region(FaceLook& look, std::uint32_t slot, std::uint32_t f,
                            const PlannedCollapse* planned) const {
  look.face = state_.mesh_face[f];
  look.regions = &regions_->part(mesh_index_[slot], shown_.part(f));
  const int set = look.regions->uv_set();
  std::array<const float*, 3> values;
  look.has_region_uv = set >= 0 && corner_values(find_channel(state_, Semantic::uv, set), f, planned, values);
  if (!look.has_region_uv) return;
  for (std::size_t k = 0; k < 3; ++k) look.region_uv[k] = Float4{values[k][0], values[k][1], 0, 0};
}

/// What a channel has at the corners of a face; false if it has nothing there.
bool FaceValues::corner_values(int channel, std::uint32_t f, const PlannedCollapse* planned,
                               std::array<const float*, 3>& values) const {
  if (channel < 0) return false;
  const auto i = static_cast<std::size_t>(channel);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t corner = 3 * f + k, value = state_.channels[i].corner_value[corner];
    if (value == kInvalid) return false;
    const std::uint32_t v = state_.mesh.vertex(corner);
    const bool merges = planned != nullptr && (v == planned->a || v == planned->b);
    values[k] = merges ? planned->merge->planned(i, value) : state_.channels[i].value(value);
  }
  return true;
}

/// Normals of the corners in the world; those of the face where it has none of its own.
void FaceValues::set_normals(FaceLook& look, const ShownInstance& showing, std::uint32_t f,
                             const PlannedCollapse* planned) const {
  look.is_lit = true;
  std::array<const Mat4*, 3> world;
  std::array<Vec3d, 3> p;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t v = state_.mesh.vertex(3 * f + k);
    const bool merges = planned != nullptr && (v == planned->a || v == planned->b);
    world[k] = merges ? &planned->world : &shown_.to_world(showing, v);
    p[k] = merges ? planned->position : state_.mesh.position(v);
  }
  std::array<const float*, 3> values;
  if (corner_values(normal_channel_, f, planned, values)) {
    for (std::size_t k = 0; k < 3; ++k)
      look.normal[k] = transform_normal(*world[k], {values[k][0], values[k][1], values[k][2]});
    return;
  }
  const Vec3f flat = transform_normal(*world[0], Vec3f(normalized(cross(p[1] - p[0], p[2] - p[0]))));
  look.normal = {flat, flat, flat};
}

FaceValues::Shading::Shading(const FaceValues& values, const FaceLook& look,
                             const std::array<ScreenVertex, 3>& v, std::size_t view, bool mirrored)
    : values_(values), look_(look) {
  if (values.content_ == PixelContent::face) return;
  const CornerPlanes planes(v, values.shown_.view(view).perspective);
  const std::int64_t area = double_area(v);
  const MaterialLook& material = values.materials_[look.material];
  cutoff_ = material.cutoff;
  const float side = (area > 0) == mirrored ? 1.0f : -1.0f;  // back: −1
  std::array<Float4, 3> normal{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3f n = look.is_lit ? look.normal[k] * side : Vec3f{};
    normal[k] = Float4{n.x, n.y, n.z, 1};
  }
  normal_ = planes.plane(normal);
  if (look.is_tinted) tint_ = planes.plane(look.tint);
  if (look.has_region_uv) region_uv_ = planes.plane(look.region_uv);
  if (look.is_lit) light_ = &values.lights_[view * values.finishes_.size() + material.finish];
  if (look.texture == nullptr) return;
  uv_ = planes.plane(look.uv);
  const auto pixels = static_cast<float>(std::abs(area)) / (kSubsamples * kSubsamples);
  level_ = look.texture->level_for(look.texel_area / pixels);
}

/// Where a face is looked at.
struct FaceValues::Shading::Samples {
  WideFloats x, y;
  WideFloats over_w;  ///< Numbers of planes times this are those of the surface.
};

void FaceValues::Shading::row(int y, int x0, int x1, std::uint32_t* out) const {
  std::array<std::uint32_t, 64> pixels;
  for (int begin = x0; begin < x1; begin += 64) {
    const int count = std::min(64, x1 - begin);
    for (int i = 0; i < count; ++i)
      pixels[static_cast<std::size_t>(i)] =
          static_cast<std::uint32_t>(begin + i) + (static_cast<std::uint32_t>(y) << 16);
    at(std::span(pixels).first(static_cast<std::size_t>(count)), out + (begin - x0));
  }
}

void FaceValues::Shading::at(std::span<const std::uint32_t> pixels, std::uint32_t* out) const {
  if (values_.content_ == PixelContent::face) {
    std::fill_n(out, pixels.size(), look_.number);
    return;
  }
  Samples samples;
  WideWords shown;
  for (std::size_t begin = 0; begin < pixels.size(); begin += kWide) {
    const std::size_t count = std::min(kWide, pixels.size() - begin);
    for (std::size_t i = 0; i < kWide; ++i) {  // the last pixel fills up
      const std::uint32_t pixel = pixels[begin + std::min(i, count - 1)];
      samples.x[i] = static_cast<float>(static_cast<std::int32_t>(pixel & 0xFFFF));
      samples.y[i] = static_cast<float>(static_cast<std::int32_t>(pixel >> 16));
    }
    plane_at(normal_, 3, samples.x, samples.y, samples.over_w);
    invert(samples.over_w);
    shade(samples, shown);
    std::copy_n(shown.begin(), count, out + begin);
  }
}

void FaceValues::Shading::shade(const Samples& at, WideWords& out) const {
  const auto on_surface = [&](const Plane& plane, int number, WideFloats& numbers) {
    plane_at(plane, number, at.x, at.y, numbers);
    scale(at.over_w, numbers);
  };
  WideWords color;
  color.fill(look_.color);
  WideFloats u, v;
  if (look_.texture != nullptr) {
    on_surface(uv_, 0, u);
    on_surface(uv_, 1, v);
    look_.texture->at(level_, u, v, color);
  }
  const WideWords alpha = color;
  if (look_.regions != nullptr) {
    on_surface(region_uv_, 0, u);
    on_surface(region_uv_, 1, v);
    look_.regions->regions_at(look_.face, u, v, out);
    for (std::size_t i = 0; i < kWide; ++i) {
      if (alpha[i] >> 24 < cutoff_) out[i] = FragmentLists::kHole;
    }
    return;
  }
  if (look_.is_tinted || light_ != nullptr) light_up(at, color);
  cut(alpha, cutoff_, color);
  out = color;
}

/// Vertex colours and light on base colour.
void FaceValues::Shading::light_up(const Samples& at, WideWords& color) const {
  WideFloats tinted, white;
  if (light_ != nullptr) {
    WideFloats nx, ny, nz;
    plane_at(normal_, 0, at.x, at.y, nx);
    plane_at(normal_, 1, at.x, at.y, ny);
    plane_at(normal_, 2, at.x, at.y, nz);
    light_->at(nx, ny, nz, tinted, white);
  }
  const WideWords base = color;
  color.fill(0);
  for (int channel = 0; channel < 3; ++channel) {
    WideFloats display, tint;
    unpack(base, channel, display);
    if (look_.is_tinted) {
      plane_at(tint_, channel, at.x, at.y, tint);
      scale(at.over_w, tint);
      scale(tint, display);
    }
    if (light_ != nullptr) light_channel(tinted, white, display);
    pack(display, channel, color);
  }
}

}  // namespace fovea
