#include "info_report.h"

namespace fovea::cli {

namespace {

Json point(Vec3d p) { return {number_json(p.x), number_json(p.y), number_json(p.z)}; }

Json bounds_json(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"low", point(box.low)}, {"high", point(box.high)}, {"diagonal", number_json(box.diagonal())}};
}

Json edges_json(const EdgeCounts& edges) {
  return {{"total", edges.total}, {"boundary", edges.boundary},         {"interior", edges.interior},
          {"seam", edges.seam},   {"non_manifold", edges.non_manifold}, {"part_border", edges.part_border}};
}

Json layers_json(const MeshFacts& facts) {
  Json json = Json::array();
  for (const LayerFacts& layer : facts.layers) {
    json.push_back({{"name", layer.name}, {"values", layer.values}, {"seam_values", layer.seam_values}});
  }
  return json;
}

Json mesh_json(const Mesh& mesh, const MeshFacts& facts) {
  return {{"name", mesh.name},
          {"triangles", mesh.surface.face_count()},
          {"vertices", mesh.surface.vertex_count()},
          {"split_vertices", facts.split_vertices},
          {"parts", mesh.surface.parts.size()},
          {"raw_parts", facts.raw_parts},
          {"shown", facts.shown},
          {"components", facts.components},
          {"bow_ties", facts.bow_ties},
          {"edges", edges_json(facts.edges)},
          {"layers", layers_json(facts)},
          {"morph_targets", mesh.surface.target_count()},
          {"skinned", facts.skinned}};
}

const char* to_string(AlphaMode mode) {
  switch (mode) {
    case AlphaMode::opaque: return "opaque";
    case AlphaMode::mask: return "mask";
    case AlphaMode::blend: return "blend";
  }
  return "opaque";
}

Json material_json(const Material& material, const std::vector<TextureUse>& uses) {
  Json textures = Json::array();
  for (const TextureUse& use : uses) {
    textures.push_back(
        {{"role", use.role}, {"texture", use.texture}, {"image", use.image}, {"uv_set", use.uv_set}});
  }
  return {{"name", material.name},
          {"alpha_mode", to_string(material.alpha_mode)},
          {"double_sided", material.double_sided},
          {"textures", textures}};
}

Json image_json(const EncodedImage& image, const ImageInfo& info) {
  return {{"name", image.name},         {"uri", image.uri},      {"mime_type", image.mime_type},
          {"width", info.width},        {"height", info.height}, {"channels", info.channels},
          {"bytes", image.bytes.size()}};
}

}  // namespace

void add_info_json(Json& report, const Model& model, const ModelFacts& facts, const Snapshot& totals) {
  const auto list = [&](const char* key, std::size_t count, const auto& item) {
    Json& json = report[key] = Json::array();
    for (std::size_t i = 0; i < count; ++i) json.push_back(item(i));
  };
  report["generator"] = facts.generator;
  report["totals"] = to_json(totals);
  report["bounds"] = bounds_json(facts.box);
  list("meshes", model.meshes.size(),
       [&](std::size_t i) { return mesh_json(model.meshes[i], facts.meshes[i]); });
  list("materials", model.materials.size(),
       [&](std::size_t i) { return material_json(model.materials[i], facts.textures[i]); });
  list("images", model.images.size(),
       [&](std::size_t i) { return image_json(model.images[i], facts.images[i]); });
  list("animations", model.animations.size(), [&](std::size_t i) -> Json {
    const Animation& animation = model.animations[i];
    return {{"name", animation.name},
            {"channels", animation.channels.size()},
            {"duration_s", facts.animation_seconds[i]}};
  });
  list("skins", model.skins.size(), [&](std::size_t i) -> Json {
    return {{"name", model.skins[i].name}, {"joints", model.skins[i].joints.size()}};
  });
  list("cameras", model.cameras.size(), [&](std::size_t i) -> Json {
    return {{"name", model.cameras[i].name}, {"perspective", model.cameras[i].perspective}};
  });
  report["nodes"] = model.nodes.size();
  report["extensions_used"] = model.extensions_used;
  report["extensions_required"] = model.extensions_required;
}

}  // namespace fovea::cli
