#include "fovea/texture/normal_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "fovea/io/image_codec.h"
#include "fovea/model/texture_use.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/fill.h"
#include "fovea/texture/texel_scan.h"

namespace fovea {

namespace {

/// How flat a normal may lie in a map: no map says what faces away.
constexpr double kLeastHeight = 0.05;

Image8 flat_map(int width, int height) {
  Image8 image(width, height, 3, ColorEncoding::linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i % 3 == 2 ? 255 : 128;
  return image;
}

std::uint8_t byte(double x) {
  return static_cast<std::uint8_t>(std::clamp(x * 127.5 + 127.5, 0.0, 255.0) + 0.5);
}

/// The materials of an atlas that may have a normal map there, each with its set of coordinates.
std::map<int, int> lit_materials(const Model& model, const Atlas& atlas) {
  std::map<int, int> sets;
  for (const AtlasPart& part : atlas.parts) {
    const int material = model.meshes[part.mesh].surface.parts[part.part].material;
    if (material >= 0 && !model.materials[static_cast<std::size_t>(material)].unlit)
      sets.try_emplace(material, part.uv_set);
  }
  return sets;
}

/// Of the base colour of these materials, or of the atlas's first image.
int model_image(const Model& model, const Atlas& atlas, const std::map<int, int>& materials) {
  for (const auto& [material, set] : materials) {
    const int image = image_of(model, model.materials[static_cast<std::size_t>(material)].base_color);
    if (std::ranges::binary_search(atlas.images, image)) return image;
  }
  return atlas.images.front();
}

EncodedImage encoded_flat(const EncodedImage& like) {
  const ImageInfo info = image_info(like.bytes);
  const Image8 image = flat_map(info.width, info.height);
  EncodedImage result;
  result.name = "normals";
  result.mime_type = info.mime_type;
  if (info.mime_type == "image/jpeg") {
    result.bytes = encode_jpeg(image, 90);
  } else if (info.mime_type == "image/webp") {
    result.bytes = encode_webp(image, 101);
  } else {
    result.mime_type = "image/png";
    result.bytes = encode_png(image);
  }
  return result;
}

/// The sampler of what the new map lies beside.
int sampler_of(const Model& model, int image) {
  for (const Texture& texture : model.textures) {
    if (texture.image == image) return texture.sampler;
  }
  return -1;
}

void add_tangents(Model& model, const Atlas& atlas, const std::map<int, int>& materials) {
  const std::vector<AtlasFace> faces = atlas_faces(model, atlas);
  const TangentFrames frames(model, faces);
  // One tangent per coordinate and normal.
  std::vector<std::map<std::pair<std::uint32_t, std::uint32_t>, ValueId>> known(model.meshes.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    TriMesh& mesh = model.meshes[faces[f].mesh].surface;
    const auto material = materials.find(mesh.parts[mesh.face_part[faces[f].face]].material);
    if (material == materials.end()) continue;
    AttributeLayer* layer = mesh.find(Semantic::tangent);
    if (layer == nullptr) {
      layer = &mesh.layers.emplace_back();
      layer->semantic = Semantic::tangent;
      layer->width = 4;
      layer->corner_value.resize(3 * mesh.face_count());
    }
    const AttributeLayer& normals = *mesh.find(Semantic::normal);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = std::size_t{3} * faces[f].face + k;
      if (layer->corner_value[corner].valid()) continue;
      ValueId& value = known[faces[f].mesh][{faces[f].value[k], normals.corner_value[corner].value}];
      if (!value.valid()) {
        value = ValueId(layer->size());
        const std::array<float, 4> tangent = frames.corner_tangent(f, k);
        layer->values.insert(layer->values.end(), tangent.begin(), tangent.end());
      }
      layer->corner_value[corner] = value;
    }
  }
}

}  // namespace

bool has_normals(const Model& model, const Atlas& atlas) {
  return std::ranges::all_of(atlas.parts, [&](const AtlasPart& part) {
    return model.meshes[part.mesh].surface.find(Semantic::normal) != nullptr;
  });
}

std::set<int> add_normal_maps(Model& model, std::span<const Atlas> atlases) {
  std::set<int> added;
  for (const Atlas& atlas : atlases) {
    if (!atlas.fixed_because.empty() || !has_normals(model, atlas)) continue;
    const std::map<int, int> materials = lit_materials(model, atlas);
    int texture = -1;
    std::map<int, int> given;  // of those
    for (const auto& [material, set] : materials) {
      std::optional<TextureRef>& normal = model.materials[static_cast<std::size_t>(material)].normal;
      if (image_of(model, normal) >= 0) continue;
      if (texture < 0) {
        const int like = model_image(model, atlas, materials);
        texture = static_cast<int>(model.textures.size());
        added.insert(static_cast<int>(model.images.size()));
        model.textures.push_back({static_cast<int>(model.images.size()), sampler_of(model, like), "", ""});
        model.images.push_back(encoded_flat(model.images[static_cast<std::size_t>(like)]));
      }
      normal = TextureRef{texture, set, {}};
      given.emplace(material, set);
    }
    // Maps that there are would be lit otherwise by tangents that they were not made for.
    if (!given.empty()) add_tangents(model, atlas, given);
  }
  return added;
}

Image8 baked_normals(const SurfaceOrigin& origin, const Model& simplified, const Image8* map, double scale,
                     int width, int height, const Context& context) {
  const TangentFrames frames(simplified, origin.faces());
  const MipMap texels = map != nullptr ? MipMap(*map, ColorEncoding::linear) : MipMap();
  const std::vector<UvSlopes> slopes = texel_slopes(origin.faces(), origin.faces(), width, height);
  const Sampler clamp = clamping_sampler();
  const auto bent = [&](Vec2d uv, std::uint32_t face) {
    if (map == nullptr) return Vec3d{0, 0, 1};
    const Rgba look =
        texels.sample({static_cast<float>(uv.x), static_cast<float>(uv.y)}, slopes[face], clamp, 4);
    const auto number = [](float x) { return 2 * static_cast<double>(x) - 1; };
    return normalized(Vec3d{number(look.r) * scale, number(look.g) * scale, number(look.b)});
  };
  std::vector<Vec3f> sums(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<std::uint8_t> drawn(sums.size(), 0);
  const auto add = [&](std::uint32_t face, const std::array<double, 3>& weights, std::size_t texel) {
    const auto found = origin.place(face, weights);
    Vec3d normal;
    if (found) {
      const Vec2d uv = uv_at(origin.original_faces()[found->face], found->weights);
      normal = frames.at(face, weights)
                   .in(origin.original_frames().at(found->face, found->weights).out(bent(uv, face)));
    } else {
      normal = bent(uv_at(origin.faces()[face], weights), face);
    }
    normal.z = std::max(normal.z, kLeastHeight);
    sums[texel] += Vec3f(normalized(normal));
    drawn[texel] = 1;
  };
  for_atlas_texels(origin.faces(), width, height, add, context);
  Image8 result(width, height, map != nullptr ? map->channels : 3, ColorEncoding::linear);
  std::ranges::fill(result.pixels, std::uint8_t{255});
  const double unscaled = scale != 0 ? 1 / scale : 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (drawn[i] == 0) continue;
    const Vec3d sum(sums[i]);
    const Vec3d stored = normalized(Vec3d{sum.x * unscaled, sum.y * unscaled, sum.z});
    std::uint8_t* out = &result.pixels[i * static_cast<std::size_t>(result.channels)];
    out[0] = byte(stored.x);
    out[1] = byte(stored.y);
    out[2] = byte(stored.z);
  }
  fill_undrawn(result, drawn, context);
  return result;
}

}  // namespace fovea
