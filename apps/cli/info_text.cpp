#include <fmt/format.h>

#include <algorithm>

#include "info_report.h"
#include "text.h"

namespace fovea::cli {

namespace {

constexpr std::size_t kLongList = 24;

std::string name_text(const std::string& name) {
  constexpr std::size_t kLongest = 32;
  const std::string text = printable(name);
  if (text.empty()) return "-";
  return text.size() <= kLongest ? text : text.substr(0, kLongest - 3) + "...";
}

std::size_t shown_rows(std::size_t count, bool everything) {
  return everything || count <= kLongList ? count : kLongList;
}

std::string rest_text(std::size_t count, std::size_t shown) {
  return count == shown ? "" : fmt::format("  and {} more: --verbose shows all\n", count_text(count - shown));
}

std::string kind_text(const ImageInfo& info, const EncodedImage& image) {
  const std::string& mime = info.mime_type.empty() ? image.mime_type : info.mime_type;
  return mime.rfind("image/", 0) == 0 ? mime.substr(6) : mime;
}

std::string size_text(const ImageInfo& info) {
  return info.width > 0 ? fmt::format("{}x{}", info.width, info.height) : "?";
}

std::string summary_text(const Model& model, const ModelFacts& facts, const Snapshot& totals) {
  std::string text = fmt::format(
      "{}, {}, {} split at seams\n", plural(totals.counts.triangles, "triangle", "triangles"),
      plural(totals.counts.vertices, "vertex", "vertices"), count_text(totals.counts.split_vertices));
  if (totals.counts.triangles_drawn != totals.counts.triangles) {
    text += fmt::format("{} drawn, instances counted as often as they are shown\n",
                        plural(totals.counts.triangles_drawn, "triangle", "triangles"));
  }
  if (!facts.box.empty()) {
    const Vec3d size = facts.box.high - facts.box.low, center = facts.box.center();
    text += fmt::format("box {} x {} x {}, diagonal {}, centre {} {} {}\n", number_text(size.x),
                        number_text(size.y), number_text(size.z), number_text(facts.box.diagonal()),
                        number_text(center.x), number_text(center.y), number_text(center.z));
  }
  const auto part = [&](std::size_t count, const char* one, const char* many) {
    return count == 0 ? std::string() : ", " + plural(count, one, many);
  };
  return text + plural(model.nodes.size(), "node", "nodes") + part(model.scenes.size(), "scene", "scenes") +
         part(model.skins.size(), "skin", "skins") + part(model.cameras.size(), "camera", "cameras") + "\n";
}

std::string layers_text(const MeshFacts& facts) {
  std::string text;
  for (const LayerFacts& layer : facts.layers) {
    text += (text.empty() ? "" : " ") + printable(layer.name) + (layer.seam_values > 0 ? "*" : "");
  }
  return text;
}

std::string mesh_notes(const Mesh& mesh, const MeshFacts& facts) {
  std::string text = layers_text(facts);
  const auto add = [&](const std::string& note) { text += (text.empty() ? "" : ", ") + note; };
  if (const std::size_t targets = mesh.surface.target_count())
    add(plural(targets, "morph target", "morph targets"));
  if (facts.skinned) add("skinned");
  if (facts.shown != 1) add(fmt::format("shown {} times", count_text(facts.shown)));
  if (facts.raw_parts > 0) add(plural(facts.raw_parts, "part", "parts") + " of points or lines");
  if (facts.bow_ties > 0) add(plural(facts.bow_ties, "bow tie", "bow ties"));
  return text;
}

std::string meshes_text(const Model& model, const ModelFacts& facts, bool everything) {
  if (model.meshes.empty()) return {};
  TextTable table("rlrrrrrrrrl");
  table.row({"", "name", "triangles", "vertices", "split", "parts", "pieces", "boundary", "seam",
             "non-manifold", "attributes (* has seams)"});
  const std::size_t shown = shown_rows(model.meshes.size(), everything);
  for (std::size_t i = 0; i < shown; ++i) {
    const Mesh& mesh = model.meshes[i];
    const MeshFacts& f = facts.meshes[i];
    table.row({std::to_string(i), name_text(mesh.name), count_text(mesh.surface.face_count()),
               count_text(mesh.surface.vertex_count()), count_text(f.split_vertices),
               count_text(mesh.surface.parts.size()), count_text(f.components), count_text(f.edges.boundary),
               count_text(f.edges.seam), count_text(f.edges.non_manifold), mesh_notes(mesh, f)});
  }
  return "\nMeshes (boundary, seam, non-manifold: edges)\n" + table.text(2) +
         rest_text(model.meshes.size(), shown);
}

std::string material_notes(const Material& material) {
  std::string text;
  if (material.alpha_mode == AlphaMode::mask) text += ", alpha mask";
  if (material.alpha_mode == AlphaMode::blend) text += ", alpha blend";
  if (material.double_sided) text += ", double-sided";
  if (material.unlit) text += ", unlit";
  return text;
}

std::string texture_text(const Model& model, const ModelFacts& facts, const TextureUse& use) {
  if (use.image < 0) return "no image";
  const auto index = static_cast<std::size_t>(use.image);
  const ImageInfo& info = facts.images[index];
  return fmt::format("image {}, {} {}, {}{}", use.image, size_text(info),
                     kind_text(info, model.images[index]), bytes_text(model.images[index].bytes.size()),
                     use.uv_set > 0 ? fmt::format(", TEXCOORD_{}", use.uv_set) : "");
}

std::string materials_text(const Model& model, const ModelFacts& facts, bool everything) {
  if (model.materials.empty()) return {};
  std::string text = "\nMaterials\n";
  const std::size_t shown = shown_rows(model.materials.size(), everything);
  for (std::size_t i = 0; i < shown; ++i) {
    text += fmt::format("  {}  {}{}\n", i, name_text(model.materials[i].name),
                        material_notes(model.materials[i]));
    TextTable table("l");
    for (const TextureUse& use : facts.textures[i]) {
      table.row({printable(use.role), texture_text(model, facts, use)});
    }
    text += table.text(5);
  }
  return text + rest_text(model.materials.size(), shown);
}

std::string images_text(const Model& model, const ModelFacts& facts, bool everything) {
  if (model.images.empty()) return {};
  TextTable table("rlllr");
  const std::size_t shown = shown_rows(model.images.size(), everything);
  for (std::size_t i = 0; i < shown; ++i) {
    const EncodedImage& image = model.images[i];
    table.row({std::to_string(i), name_text(image.name.empty() ? image.uri : image.name),
               size_text(facts.images[i]), kind_text(facts.images[i], image),
               bytes_text(image.bytes.size())});
  }
  return "\nImages\n" + table.text(2) + rest_text(model.images.size(), shown);
}

std::string animations_text(const Model& model, const ModelFacts& facts, bool everything) {
  if (model.animations.empty()) return {};
  TextTable table("rlrr");
  const std::size_t shown = shown_rows(model.animations.size(), everything);
  for (std::size_t i = 0; i < shown; ++i) {
    table.row({std::to_string(i), name_text(model.animations[i].name),
               plural(model.animations[i].channels.size(), "channel", "channels"),
               seconds_text(facts.animation_seconds[i])});
  }
  return "\nAnimations\n" + table.text(2) + rest_text(model.animations.size(), shown);
}

std::string skins_text(const Model& model, bool everything) {
  if (model.skins.empty()) return {};
  TextTable table("rlr");
  const std::size_t shown = shown_rows(model.skins.size(), everything);
  for (std::size_t i = 0; i < shown; ++i) {
    table.row({std::to_string(i), name_text(model.skins[i].name),
               plural(model.skins[i].joints.size(), "joint", "joints")});
  }
  return "\nSkins\n" + table.text(2) + rest_text(model.skins.size(), shown);
}

std::string cameras_text(const Model& model, bool everything) {
  if (model.cameras.empty()) return {};
  TextTable table("rll");
  const std::size_t shown = shown_rows(model.cameras.size(), everything);
  for (std::size_t i = 0; i < shown; ++i) {
    table.row({std::to_string(i), name_text(model.cameras[i].name),
               model.cameras[i].perspective ? "perspective" : "orthographic"});
  }
  return "\nCameras\n" + table.text(2) + rest_text(model.cameras.size(), shown);
}

std::string extensions_text(const Model& model) {
  if (model.extensions_used.empty()) return {};
  std::string text = "\nExtensions\n";
  for (const std::string& name : model.extensions_used) {
    const auto& required = model.extensions_required;
    const bool needed = std::find(required.begin(), required.end(), name) != required.end();
    text += "  " + printable(name) + (needed ? " (required)" : "") + "\n";
  }
  return text;
}

std::string bytes_table(const FileBytes& bytes) {
  TextTable table("lr");
  const auto row = [&](const char* name, std::uint64_t size) {
    if (size > 0) table.row({name, bytes_text(size), percent_text(size, bytes.files)});
  };
  row("geometry", bytes.kinds.geometry);
  row("images", bytes.kinds.images);
  row("animation", bytes.kinds.animation);
  row("other", bytes.kinds.other);
  table.row({"all", bytes_text(bytes.files)});
  return "\nBytes\n" + table.text(2);
}

}  // namespace

std::string info_text(const std::string& path, const Model& model, const ModelFacts& facts,
                      const Snapshot& totals, bool everything) {
  std::string text = fmt::format("{}: {}, {}{}\n", printable(path), to_string(totals.bytes.format),
                                 bytes_text(totals.bytes.files),
                                 facts.generator.empty() ? "" : ", made by " + printable(facts.generator));
  text += summary_text(model, facts, totals);
  text += meshes_text(model, facts, everything);
  text += materials_text(model, facts, everything);
  text += images_text(model, facts, everything);
  text += animations_text(model, facts, everything);
  text += skins_text(model, everything);
  text += cameras_text(model, everything);
  text += extensions_text(model);
  return text + bytes_table(totals.bytes);
}

}  // namespace fovea::cli
