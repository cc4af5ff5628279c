#include "fovea/io/gltf_json_write.h"

#include <array>
#include <cmath>

#include "fovea/base/error.h"

namespace fovea::gltf {

namespace {

/// Where a texture may name its image, and the type of image that belongs there.
struct ImageHome {
  const char* extension;
  const char* mime_type;
};
constexpr ImageHome kImageHomes[] = {{"EXT_texture_webp", "image/webp"},
                                     {"KHR_texture_basisu", "image/ktx2"},
                                     {"EXT_texture_avif", "image/avif"},
                                     {"MSFT_texture_dds", "image/vnd-ms.dds"}};

int index_at(const Json& object, const char* key, int standard) {
  const auto at = object.find(key);
  return at != object.end() && at->is_number_integer() ? at->get<int>() : standard;
}

Json quaternion(Quat q) { return numbers(std::array{q.x, q.y, q.z, q.w}); }

Json index_list(const std::vector<int>& indices) { return indices.empty() ? Json() : Json(indices); }

Json number_list(const std::vector<double>& values) { return values.empty() ? Json() : numbers(values); }

const Json& member_or(const Json& object, const char* key, const Json& standard) {
  const auto at = object.find(key);
  return at != object.end() ? *at : standard;
}

void refresh_transform(Json& info, const std::optional<TextureTransform>& transform) {
  constexpr const char* kName = "KHR_texture_transform";
  if (!transform) {
    erase_extension(info, kName);
    return;
  }
  const Json* present = find_extension(info, kName);
  if (!present && *transform == TextureTransform{}) return;
  Json extension = present ? *present : Json::object();
  refresh(extension, "offset", numbers(std::array{transform->offset.x, transform->offset.y}), {0, 0});
  refresh(extension, "rotation", number(transform->rotation_rad), 0);
  refresh(extension, "scale", numbers(std::array{transform->scale.x, transform->scale.y}), {1, 1});
  if (!present || *present != extension) info["extensions"][kName] = std::move(extension);
}

/// The transform may carry a UV set of its own, which then wins.
void refresh_uv_set(Json& info, int uv_set) {
  const Json* transform = find_extension(info, "KHR_texture_transform");
  const int own = index_at(info, "texCoord", 0);
  if ((transform ? index_at(*transform, "texCoord", own) : own) == uv_set) return;
  if (transform) info["extensions"]["KHR_texture_transform"].erase("texCoord");
  refresh(info, "texCoord", uv_set, 0);
}

void refresh_texture(Json& object, const char* key, const std::optional<TextureRef>& ref) {
  if (!ref || ref->texture < 0) {
    object.erase(key);
    return;
  }
  Json& info = object[key];
  if (!info.is_object()) info = Json::object();
  refresh(info, "index", ref->texture);
  refresh_uv_set(info, ref->uv_set);
  refresh_transform(info, ref->transform);
}

void refresh_metallic_roughness(Json& object, const Material& m) {
  Json pbr = member_or(object, "pbrMetallicRoughness", Json::object());
  refresh(pbr, "baseColorFactor", numbers(m.base_color_factor), {1, 1, 1, 1});
  refresh_texture(pbr, "baseColorTexture", m.base_color);
  refresh(pbr, "metallicFactor", number(m.metallic_factor), 1);
  refresh(pbr, "roughnessFactor", number(m.roughness_factor), 1);
  refresh_texture(pbr, "metallicRoughnessTexture", m.metallic_roughness);
  refresh(object, "pbrMetallicRoughness", pbr, Json::object());
}

void refresh_unlit(Json& object, bool unlit) {
  constexpr const char* kName = "KHR_materials_unlit";
  if (!unlit) {
    erase_extension(object, kName);
  } else if (!find_extension(object, kName)) {
    object["extensions"][kName] = Json::object();
  }
}

Json perspective_json(Json lens, const Camera& camera) {
  refresh(lens, "aspectRatio", camera.aspect ? number(*camera.aspect) : Json());
  refresh(lens, "yfov", number(camera.yfov_rad));
  refresh(lens, "zfar", camera.zfar ? number(*camera.zfar) : Json());
  refresh(lens, "znear", number(camera.znear));
  return lens;
}

Json orthographic_json(Json lens, const Camera& camera) {
  refresh(lens, "xmag", number(camera.xmag));
  refresh(lens, "ymag", number(camera.ymag));
  refresh(lens, "zfar", camera.zfar ? number(*camera.zfar) : Json());
  refresh(lens, "znear", number(camera.znear));
  return lens;
}

void refresh_placement(Json& object, const Node& node) {
  if (node.matrix) {
    for (const char* key : {"translation", "rotation", "scale"}) object.erase(key);
    refresh(object, "matrix", numbers(node.matrix->m), numbers(Mat4{}.m));
    return;
  }
  object.erase("matrix");
  refresh(object, "translation", numbers(node.translation), numbers(Vec3d{0, 0, 0}));
  refresh(object, "rotation", quaternion(node.rotation), quaternion(Quat{}));
  refresh(object, "scale", numbers(node.scale), numbers(Vec3d{1, 1, 1}));
}

}  // namespace

Json parse_object(const std::string& text) {
  if (text.empty()) return Json::object();
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw Error(ErrorKind::usage, "an element carries text that is not a JSON object");
  return json;
}

Json number(double value) {
  constexpr double kExactIntegers = 9007199254740992.0;
  const bool negative_zero = value == 0 && std::signbit(value);
  if (std::trunc(value) == value && std::abs(value) < kExactIntegers && !negative_zero) {
    return static_cast<std::int64_t>(value);
  }
  return value;
}

Json numbers(std::span<const double> values) {
  Json list = Json::array();
  for (const double v : values) list.push_back(number(v));
  return list;
}

Json numbers(Vec3d v) { return numbers(std::array{v.x, v.y, v.z}); }

void refresh(Json& object, const char* key, const Json& value, const Json& standard) {
  const auto at = object.find(key);
  if ((at != object.end() ? *at : standard) == value) return;
  if (value == standard) {
    object.erase(key);
  } else {
    object[key] = value;
  }
}

void refresh_index(Json& object, const char* key, int index) {
  refresh(object, key, index >= 0 ? Json(index) : Json());
}

const Json* find_extension(const Json& object, const char* name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end() || !extensions->is_object()) return nullptr;
  const auto at = extensions->find(name);
  return at != extensions->end() ? &*at : nullptr;
}

void erase_extension(Json& object, const char* name) {
  if (!find_extension(object, name)) return;
  object["extensions"].erase(name);
  if (object["extensions"].empty()) object.erase("extensions");
}

std::string to_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json material_json(const Material& m) {
  static constexpr const char* kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
  Json object = parse_object(m.json);
  refresh(object, "name", m.name, "");
  refresh_metallic_roughness(object, m);
  refresh_texture(object, "normalTexture", m.normal);
  if (object.contains("normalTexture")) {
    refresh(object["normalTexture"], "scale", number(m.normal_scale), 1);
  }
  refresh_texture(object, "occlusionTexture", m.occlusion);
  if (object.contains("occlusionTexture")) {
    refresh(object["occlusionTexture"], "strength", number(m.occlusion_strength), 1);
  }
  refresh_texture(object, "emissiveTexture", m.emissive);
  refresh(object, "emissiveFactor", numbers(m.emissive_factor), {0, 0, 0});
  refresh(object, "alphaMode", kAlphaModes[static_cast<int>(m.alpha_mode)], "OPAQUE");
  if (m.alpha_mode == AlphaMode::mask) refresh(object, "alphaCutoff", number(m.alpha_cutoff), 0.5);
  refresh(object, "doubleSided", m.double_sided, false);
  refresh_unlit(object, m.unlit);
  return object;
}

Json sampler_json(const Sampler& s) {
  const auto filter = [](std::optional<int> f) { return f ? Json(*f) : Json(); };
  const Json repeat = static_cast<int>(Wrap::repeat);
  Json object = parse_object(s.json);
  refresh(object, "magFilter", filter(s.mag_filter));
  refresh(object, "minFilter", filter(s.min_filter));
  refresh(object, "wrapS", static_cast<int>(s.wrap_u), repeat);
  refresh(object, "wrapT", static_cast<int>(s.wrap_v), repeat);
  return object;
}

Json texture_json(const Texture& t, const std::string& mime_type) {
  Json object = parse_object(t.json);
  refresh(object, "name", t.name, "");
  refresh_index(object, "sampler", t.sampler);
  for (const ImageHome& home : kImageHomes) {
    const Json* extension = find_extension(object, home.extension);
    const int named = extension && extension->is_object() ? index_at(*extension, "source", -1) : -1;
    if (mime_type == home.mime_type) {
      if (named != t.image) object["extensions"][home.extension]["source"] = t.image;
      // The plain member may hold a fallback of another format, but not this image.
      if (index_at(object, "source", -1) == t.image) object.erase("source");
      return object;
    }
    if (named == t.image) erase_extension(object, home.extension);
  }
  // What is left may still name images of formats that come before the plain one: none of them is
  // the texture's image any more.
  if (index_at(object, "source", -1) != t.image) {
    for (const ImageHome& home : kImageHomes) erase_extension(object, home.extension);
  }
  refresh_index(object, "source", t.image);
  return object;
}

Json camera_json(const Camera& c) {
  const char* kind = c.perspective ? "perspective" : "orthographic";
  Json object = parse_object(c.json);
  refresh(object, "name", c.name, "");
  refresh(object, "type", kind);
  object.erase(c.perspective ? "orthographic" : "perspective");
  Json lens = member_or(object, kind, Json::object());
  lens = c.perspective ? perspective_json(std::move(lens), c) : orthographic_json(std::move(lens), c);
  refresh(object, kind, lens);
  return object;
}

Json scene_json(const Scene& s) {
  Json object = parse_object(s.json);
  refresh(object, "name", s.name, "");
  refresh(object, "nodes", index_list(s.nodes));
  return object;
}

Json node_json(const Node& n) {
  Json object = parse_object(n.json);
  refresh(object, "name", n.name, "");
  refresh(object, "children", index_list(n.children));
  refresh_index(object, "mesh", n.mesh);
  refresh_index(object, "skin", n.skin);
  refresh_index(object, "camera", n.camera);
  refresh_placement(object, n);
  refresh(object, "weights", number_list(n.morph_weights));
  return object;
}

}  // namespace fovea::gltf
