#include "fovea/simplify/face_values.h"

#include <algorithm>
#include <cmath>
#include <cstring>

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

/// A number of a plane at pixels, in the order of operations that planes have.
FOVEA_WIDE_PART void plane_at(const CornerPlanes::Plane& plane, int number, const WideFloats& x,
                              const WideFloats& y, WideFloats& out) {
  out = plane.at_0[number] + plane.dx[number] * x + plane.dy[number] * y;
}

/// A channel of colours, as numbers.
FOVEA_WIDE_PART void unpack(const WideWords& colors, int channel, WideFloats& out) {
  convert(reinterpret_cast<WideInts>(colors >> (8 * channel) & 255), out);
}

/// Display values under light, nearly: the amount of light is the square.
FOVEA_WIDE_PART void light_channel(const WideFloats& tinted, const WideFloats& white, WideFloats& display) {
  const WideFloats light = display * display * tinted + white * (255.0f * 255.0f);
  for (std::size_t i = 0; i < kWide; ++i) display[i] = std::sqrt(light[i]);
}

/// Rounds a channel and puts it into colours; what is no number is full.
FOVEA_WIDE_PART void pack(const WideFloats& display, int channel, WideWords& colors) {
  const WideFloats x = display + 0.5f;
  WideInts whole;
  convert(x < 255 ? (x > 0 ? x : 0.0f) : 255.0f, whole);
  colors |= reinterpret_cast<WideWords>(whole) << (8 * channel);
}

/// Colours are opaque from here on, or holes.
FOVEA_WIDE_PART void cut(const WideWords& alpha_of, std::uint32_t cutoff, WideWords& colors) {
  colors = (alpha_of >> 24) < cutoff ? FragmentLists::kHole : colors | 0xFF000000;
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

/// Vertex colours and light on base colour.
FOVEA_WIDE_PART void FaceValues::Shading::light_up(const Samples& at, WideWords& color) const {
  WideFloats tinted{}, white{};
  if (light_ != nullptr) {
    WideFloats nx, ny, nz;
    plane_at(normal_, 0, at.x, at.y, nx);
    plane_at(normal_, 1, at.x, at.y, ny);
    plane_at(normal_, 2, at.x, at.y, nz);
    light_->at(nx, ny, nz, tinted, white);
  }
  const WideWords base = color;
  color = WideWords{};
  for (int channel = 0; channel < 3; ++channel) {
    WideFloats display, tint;
    unpack(base, channel, display);
    if (look_.is_tinted) {
      plane_at(tint_, channel, at.x, at.y, tint);
      display *= tint * at.over_w;
    }
    if (light_ != nullptr) light_channel(tinted, white, display);
    pack(display, channel, color);
  }
}

/// A number of the surface.
FOVEA_WIDE_PART void FaceValues::Shading::on_surface(const CornerPlanes::Plane& plane, int number,
                                                     const Samples& at, WideFloats& out) {
  plane_at(plane, number, at.x, at.y, out);
  out *= at.over_w;
}

FOVEA_WIDE_PART void FaceValues::Shading::color_at(const Samples& at, WideWords& out) const {
  out = WideWords{} + look_.color;
  if (look_.texture == nullptr) return;
  WideFloats u, v;
  on_surface(uv_, 0, at, u);
  on_surface(uv_, 1, at, v);
  look_.texture->at(level_, u, v, out);
}

/// The texel that says which region there is; kInvalid in a hole.
FOVEA_WIDE_PART void FaceValues::Shading::region_texel(const Samples& at, WideWords& out) const {
  out = WideWords{};
  if (look_.regions->is_textured()) {
    WideFloats u, v;
    on_surface(region_uv_, 0, at, u);
    on_surface(region_uv_, 1, at, v);
    look_.regions->texels_at(u, v, out);
  }
  if (cutoff_ == 0) return;
  WideWords color;
  color_at(at, color);
  out = (color >> 24) < cutoff_ ? kInvalid : out;
}

FOVEA_WIDE_PART void FaceValues::Shading::shade(const Samples& at, WideWords& out) const {
  WideWords color;
  color_at(at, color);
  const WideWords alpha = color;
  if (look_.is_tinted || light_ != nullptr) light_up(at, color);
  cut(alpha, cutoff_, color);
  out = color;
}

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

FOVEA_WIDE void FaceValues::Shading::at(std::span<const std::uint32_t> pixels, std::uint32_t* out) const {
  if (values_.content_ == PixelContent::face) {
    std::fill_n(out, pixels.size(), look_.number);
    return;
  }
  const PartRegions* const regions = look_.regions;
  Samples samples;
  for (std::size_t begin = 0; begin < pixels.size(); begin += kWide) {
    const std::size_t count = std::min(kWide, pixels.size() - begin);
    WideWords pixel, shown;
    for (std::size_t i = 0; i < kWide; ++i) pixel[i] = pixels[begin + std::min(i, count - 1)];  // fills up
    convert(reinterpret_cast<WideInts>(pixel & 0xFFFF), samples.x);
    convert(reinterpret_cast<WideInts>(pixel >> 16), samples.y);
    plane_at(normal_, 3, samples.x, samples.y, samples.over_w);
    samples.over_w = 1 / samples.over_w;
    if (regions != nullptr) {
      region_texel(samples, shown);
    } else {
      shade(samples, shown);
    }
    std::memcpy(out + begin, &shown, count * sizeof(std::uint32_t));
    if (regions == nullptr || !regions->is_textured()) continue;
    for (std::size_t i = 0; i < count; ++i) regions->prefetch_texel(out[begin + i]);
  }
  if (regions == nullptr) return;
  const std::uint32_t of_face = regions->is_textured() ? 0 : regions->region_of(look_.face);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (out[i] == kInvalid) {
      out[i] = FragmentLists::kHole;
    } else {
      out[i] = regions->is_textured() ? regions->region_of_texel(out[i]) : of_face;
    }
  }
}

}  // namespace fovea
