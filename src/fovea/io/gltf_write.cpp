#include "fovea/io/gltf_write.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <string_view>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/io/glb_write.h"
#include "fovea/io/gltf_buffer_write.h"
#include "fovea/io/gltf_extensions_write.h"
#include "fovea/io/gltf_images_write.h"
#include "fovea/io/gltf_instances.h"
#include "fovea/io/gltf_json_write.h"
#include "fovea/io/gltf_primitive_write.h"
#include "fovea/io/gltf_quantize.h"
#include "fovea/io/gltf_shared_vertices.h"
#include "fovea/model/weld.h"

namespace fovea {

namespace gltf {

namespace {

/// One part on its way: what it was, where it goes, and what was said about it.
struct PartJob {
  std::size_t mesh = 0;
  std::string place;
  SplitPart split;
  bool ordered = false;  ///< Whether it has the vertices of other levels, too.
  EncodedPart encoded;
  Context notes;
};

/// Everything that `write_gltf` knows while it works.
class Writer {
 public:
  Writer(const Model& model, bool binary, const std::string& stem, const WriteOptions& options,
         Context& context, std::span<const int> vertices_of)
      : model_(model),
        vertices_of_(vertices_of),
        binary_(binary),
        stem_(stem),
        options_(options),
        context_(context),
        buffers_(options.compression) {
    // Version 1 of the index coding is what EXT_meshopt_compression asks for.
    meshopt_encodeIndexVersion(1);
  }

  GltfOutput run() {
    check_references();
    plan_ = plan_quantization(model_, vertices_of_, options_, context_);
    place_carried_data();
    encode_meshes();
    place_meshes();
    make_nodes();
    make_skins();
    make_animations();
    make_images();
    make_json_only();
    buffers_.finish();
    context_.advance_or_throw("write", 0.9);
    return make_files();
  }

 private:
  void check_references() const;
  void place_carried_data();
  void encode_meshes();
  void share_vertices();
  int vertices_of(std::size_t mesh) const { return mesh < vertices_of_.size() ? vertices_of_[mesh] : -1; }
  void place_meshes();
  Json mesh_object(const Mesh& mesh, std::vector<Json>&& primitives) const;
  void make_nodes();
  void make_skins();
  void make_animations();
  Json sampler_object(const AnimationSampler& sampler);
  void make_channel(const AnimationChannel& channel, const std::string& place, Json& channels);
  bool remap_pointer(Json& target) const;
  void make_images();
  void make_json_only();
  Json root_object();
  Json buffer_list() const;
  GltfOutput make_files();

  const Model& model_;
  std::span<const int> vertices_of_;
  bool binary_;
  const std::string& stem_;
  const WriteOptions& options_;
  Context& context_;
  BufferWriter buffers_;
  QuantizationPlan plan_;
  std::vector<std::unique_ptr<PartJob>> jobs_;  // by mesh, then by part
  std::vector<int> mesh_index_;                 // [#meshes], -1 for those that nothing is left of
  bool quantized_ = false;
  Json lists_ = Json::object();  // arrays of the root object by name
  std::vector<OutputFile> side_files_;
};

/// Readers have checked theirs; a model made in memory may be wrong.
void Writer::check_references() const {
  const auto check = [](int index, std::size_t count, const char* what, const std::string& place) {
    if (index < 0 || static_cast<std::size_t>(index) < count) return;
    throw Error(ErrorKind::usage, fmt::format("there is no {} {}", what, index), place);
  };
  for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
    check(model_.nodes[n].mesh, model_.meshes.size(), "mesh", fmt::format("/nodes/{}/mesh", n));
    check(model_.nodes[n].skin, model_.skins.size(), "skin", fmt::format("/nodes/{}/skin", n));
  }
  for (std::size_t m = 0; m < vertices_of_.size(); ++m)
    check(vertices_of_[m], m, "mesh before it", fmt::format("/meshes/{}", m));
  for (std::size_t a = 0; a < model_.animations.size(); ++a) {
    for (const AnimationChannel& channel : model_.animations[a].channels) {
      check(channel.node, model_.nodes.size(), "node", fmt::format("/animations/{}", a));
    }
  }
}

void Writer::place_carried_data() {
  for (const auto& view : model_.carried_buffer_views) buffers_.add_own_view(view);
  for (const Accessor& accessor : model_.carried_accessors) buffers_.add_own_accessor(accessor);
}

void Writer::encode_meshes() {
  std::vector<std::vector<SplitPart>> parts(model_.meshes.size());
  parallel_for(context_, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end && !context_.cancelled(); ++m)
      parts[m] = split(model_.meshes[m].surface);
  });
  context_.advance_or_throw("write", 0.2);
  for (std::size_t m = 0; m < parts.size(); ++m) {
    for (std::size_t p = 0; p < parts[m].size(); ++p) {
      auto job = std::make_unique<PartJob>();
      job->mesh = m;
      job->place = fmt::format("/meshes/{}/primitives/{}", m, p);
      job->split = std::move(parts[m][p]);
      jobs_.push_back(std::move(job));
    }
  }
  share_vertices();
  parallel_for(context_, jobs_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end && !context_.cancelled(); ++j) {
      PartJob& job = *jobs_[j];
      if (job.split.part.raw || job.split.indices.empty()) continue;
      const auto& grid = plan_.mesh_grid[job.mesh];
      job.encoded = encode_part(std::move(job.split), job.ordered, options_, grid ? &*grid : nullptr,
                                job.notes, job.place);
    }
  });
  context_.advance_or_throw("write", 0.7);
  // In order, so that the first place told does not depend on threads.
  for (const auto& job : jobs_) {
    for (const Diagnostic& d : job->notes.diagnostics()) context_.report(d.code, d.message, d.place, d.count);
  }
}

/// Gives levels of a mesh the same vertices. Equal data is stored once, so there is no more to do.
void Writer::share_vertices() {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<PartJob*>> levels;  // by mesh and part
  std::size_t part = 0;
  for (std::size_t j = 0; j < jobs_.size(); ++j) {
    part = j > 0 && jobs_[j - 1]->mesh == jobs_[j]->mesh ? part + 1 : 0;
    const std::size_t mesh = jobs_[j]->mesh;
    const int of = vertices_of(mesh);
    levels[{of >= 0 ? static_cast<std::size_t>(of) : mesh, part}].push_back(jobs_[j].get());
  }
  for (const auto& [place, jobs] : levels) {
    if (jobs.size() < 2) continue;
    std::vector<SplitPart*> parts;
    for (PartJob* job : jobs) parts.push_back(&job->split);
    if (!gltf::share_vertices(parts)) continue;
    for (PartJob* job : jobs) job->ordered = true;
  }
}

Json Writer::mesh_object(const Mesh& mesh, std::vector<Json>&& primitives) const {
  Json object = parse_object(mesh.json);
  refresh(object, "name", mesh.name, "");
  object["primitives"] = std::move(primitives);
  refresh(object, "weights", mesh.morph_weights.empty() ? Json() : numbers(mesh.morph_weights));
  return object;
}

void Writer::place_meshes() {
  Json list = Json::array();
  mesh_index_.assign(model_.meshes.size(), -1);
  auto job = jobs_.begin();
  for (std::size_t m = 0; m < model_.meshes.size(); ++m) {
    std::vector<Json> primitives;
    for (; job != jobs_.end() && (*job)->mesh == m; ++job) {
      PartJob& part = **job;
      if (part.split.part.raw) {
        primitives.push_back(place_raw(part.split.part, buffers_, quantized_));
      } else if (part.encoded.indices.count > 0) {
        quantized_ = quantized_ || part.encoded.quantized;
        primitives.push_back(place_part(std::move(part.encoded), buffers_));
      } else {
        context_.report("empty-part", "parts without triangles were left out", part.place);
      }
    }
    if (primitives.empty()) {
      context_.report("empty-mesh", "meshes without triangles were left out", fmt::format("/meshes/{}", m));
      continue;
    }
    mesh_index_[m] = static_cast<int>(list.size());
    list.push_back(mesh_object(model_.meshes[m], std::move(primitives)));
  }
  jobs_.clear();
  lists_["meshes"] = std::move(list);
}

void Writer::make_nodes() {
  Json list = Json::array();
  for (Node& node : plan_.nodes) {
    if (node.mesh >= 0) node.mesh = mesh_index_.at(static_cast<std::size_t>(node.mesh));
    const bool lost_mesh = node.mesh < 0;
    if (lost_mesh) {
      node.skin = -1;
      node.morph_weights.clear();
    }
    Json object = node_json(node);
    write_instances(object, node, model_.carried_accessors, buffers_);
    list.push_back(std::move(object));
  }
  lists_["nodes"] = std::move(list);
}

void Writer::make_skins() {
  Json list = Json::array();
  for (std::size_t s = 0; s < model_.skins.size(); ++s) {
    const Skin& skin = model_.skins[s];
    const auto& grid = plan_.skin_grid[s];
    Json object = parse_object(skin.json);
    refresh(object, "name", skin.name, "");
    object.erase("inverseBindMatrices");
    if (grid) {
      object["inverseBindMatrices"] =
          buffers_.add_packed(fold_grid(skin, *grid), PackedUse::inverse_bind, false);
    } else if (skin.inverse_bind) {
      object["inverseBindMatrices"] = buffers_.add_packed(*skin.inverse_bind, PackedUse::inverse_bind, false);
    }
    refresh(object, "joints", skin.joints);
    refresh_index(object, "skeleton", skin.skeleton);
    list.push_back(std::move(object));
  }
  lists_["skins"] = std::move(list);
}

Json Writer::sampler_object(const AnimationSampler& sampler) {
  static constexpr const char* kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
  Json object = parse_object(sampler.json);
  object["input"] = buffers_.add_packed(sampler.input, PackedUse::animation, true);
  object["output"] = buffers_.add_packed(sampler.output, PackedUse::animation, false);
  refresh(object, "interpolation", kInterpolations[static_cast<int>(sampler.interpolation)], "LINEAR");
  return object;
}

/// KHR_animation_pointer names meshes by their index. Returns whether what it names is still there.
bool Writer::remap_pointer(Json& target) const {
  constexpr const char* kName = "KHR_animation_pointer";
  constexpr std::string_view kMeshes = "/meshes/";
  const Json* extension = find_extension(target, kName);
  if (!extension || !extension->contains("pointer") || !(*extension)["pointer"].is_string()) return true;
  const std::string pointer = (*extension)["pointer"].get<std::string>();
  if (!pointer.starts_with(kMeshes)) return true;
  std::size_t end = kMeshes.size(), mesh = 0;
  for (; end < pointer.size() && pointer[end] >= '0' && pointer[end] <= '9' && end < 20; ++end) {
    mesh = 10 * mesh + static_cast<std::size_t>(pointer[end] - '0');
  }
  if (end == kMeshes.size() || mesh >= mesh_index_.size()) return true;
  if (mesh_index_[mesh] < 0) return false;
  if (static_cast<std::size_t>(mesh_index_[mesh]) == mesh) return true;
  target["extensions"][kName]["pointer"] =
      fmt::format("{}{}{}", kMeshes, mesh_index_[mesh], pointer.substr(end));
  return true;
}

void Writer::make_channel(const AnimationChannel& channel, const std::string& place, Json& channels) {
  int node = channel.node;
  if (channel.path == "weights" && node >= 0) {
    node = plan_.mesh_node.at(static_cast<std::size_t>(node));
    if (plan_.nodes[static_cast<std::size_t>(node)].mesh < 0) {
      context_.report("empty-channel", "animations of meshes without triangles were left out", place);
      return;
    }
  }
  Json object = parse_object(channel.json);
  refresh(object, "sampler", channel.sampler);
  Json& target = object["target"];
  if (!target.is_object()) target = Json::object();
  refresh_index(target, "node", node);
  refresh(target, "path", channel.path);
  if (!remap_pointer(target)) {
    context_.report("empty-channel", "animations of meshes without triangles were left out", place);
    return;
  }
  channels.push_back(std::move(object));
}

void Writer::make_animations() {
  Json list = Json::array();
  for (std::size_t a = 0; a < model_.animations.size(); ++a) {
    const Animation& animation = model_.animations[a];
    Json object = parse_object(animation.json);
    refresh(object, "name", animation.name, "");
    Json channels = Json::array(), samplers = Json::array();
    for (std::size_t c = 0; c < animation.channels.size(); ++c) {
      make_channel(animation.channels[c], fmt::format("/animations/{}/channels/{}", a, c), channels);
    }
    if (channels.empty()) {
      context_.report("empty-animation", "animations that move nothing were left out",
                      fmt::format("/animations/{}", a));
      continue;
    }
    for (const AnimationSampler& sampler : animation.samplers) samplers.push_back(sampler_object(sampler));
    object["channels"] = std::move(channels);
    object["samplers"] = std::move(samplers);
    list.push_back(std::move(object));
  }
  lists_["animations"] = std::move(list);
}

void Writer::make_images() {
  lists_["images"] = binary_ ? embed_images(model_.images, buffers_)
                             : image_files(model_.images, stem_, side_files_, buffers_.counts);
}

void Writer::make_json_only() {
  const auto make = [&](const char* name, const auto& elements, const auto& to_json) {
    Json list = Json::array();
    for (const auto& element : elements) list.push_back(to_json(element));
    lists_[name] = std::move(list);
  };
  make("scenes", model_.scenes, scene_json);
  make("cameras", model_.cameras, camera_json);
  make("materials", model_.materials, material_json);
  make("samplers", model_.samplers, sampler_json);
  make("textures", model_.textures, [&](const Texture& texture) {
    const bool has_image =
        texture.image >= 0 && static_cast<std::size_t>(texture.image) < model_.images.size();
    return texture_json(texture,
                        has_image ? image_type(model_.images[static_cast<std::size_t>(texture.image)]) : "");
  });
}

Json Writer::buffer_list() const {
  Json list = Json::array();
  if (!buffers_.bytes.empty()) {
    Json buffer = {{"byteLength", buffers_.bytes.size()}};
    if (!binary_) buffer["uri"] = percent_encode(stem_ + ".bin");
    list.push_back(std::move(buffer));
  }
  if (buffers_.fallback_bytes > 0) {
    Json buffer = {{"byteLength", buffers_.fallback_bytes}};
    buffer["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    list.push_back(std::move(buffer));
  }
  return list;
}

Json Writer::root_object() {
  Json read = parse_object(model_.json);
  Json root = Json::object();
  root["asset"] = read.value("asset", Json::object());
  root["asset"]["version"] = "2.0";
  root["asset"]["generator"] = "fovea " FOVEA_VERSION;
  // Their place in the file; filled in at the end, when it is known which are used.
  root["extensionsUsed"] = root["extensionsRequired"] = Json();
  if (model_.default_scene >= 0) root["scene"] = model_.default_scene;
  lists_["accessors"] = std::move(buffers_.accessors);
  lists_["bufferViews"] = std::move(buffers_.views);
  lists_["buffers"] = buffer_list();
  for (const char* name : {"scenes", "nodes", "cameras", "skins", "animations", "meshes", "materials",
                           "textures", "samplers", "images", "accessors", "bufferViews", "buffers"}) {
    if (!lists_[name].empty()) root[name] = std::move(lists_[name]);
  }
  for (auto& [key, value] : read.items()) {
    if (!root.contains(key)) root[key] = value;
  }
  write_extension_lists(root, model_, quantized_);
  return root;
}

GltfOutput Writer::make_files() {
  GltfOutput output;
  output.bytes = buffers_.counts;
  std::string json = to_text(root_object());
  if (binary_) {
    output.files.push_back({"", make_glb(std::move(json), buffers_.bytes)});
  } else {
    const std::byte* text = reinterpret_cast<const std::byte*>(json.data());
    output.files.push_back({"", Bytes(text, text + json.size())});
    if (!buffers_.bytes.empty()) output.files.push_back({stem_ + ".bin", std::move(buffers_.bytes)});
    std::move(side_files_.begin(), side_files_.end(), std::back_inserter(output.files));
  }
  std::uint64_t total = 0;
  for (const OutputFile& file : output.files) total += file.bytes.size();
  output.bytes.other = total - output.bytes.geometry - output.bytes.images - output.bytes.animation;
  return output;
}

}  // namespace

}  // namespace gltf

GltfOutput write_gltf(const Model& model, bool binary, const std::string& stem, const WriteOptions& options,
                      Context& context, std::span<const int> vertices_of) {
  try {
    return gltf::Writer(model, binary, stem, options, context, vertices_of).run();
  } catch (const gltf::Json::exception& e) {
    throw Error(ErrorKind::usage, fmt::format("JSON that an element carries is not glTF: {}", e.what()));
  }
}

}  // namespace fovea
