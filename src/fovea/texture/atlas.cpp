#include "fovea/texture/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "fovea/io/image_codec.h"
#include "fovea/model/texture_use.h"
#include "fovea/surface/disjoint_sets.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/texture_read.h"
#include "fovea/texture/uv_map.h"

namespace fovea {

namespace {

/// Of an image: how far coordinates may lie beyond it and still count as inside.
constexpr double kBeyond = 2e-3;
/// And how far, to be brought back inside.
constexpr double kAstray = 0.25;

/// Which images are joined by which parts.
class Finder {
 public:
  explicit Finder(const Model& model) : model_(model), reads_(model.materials.size()) {
    for (std::size_t m = 0; m < reads_.size(); ++m) reads_[m] = texture_reads(model, model.materials[m]);
    for (std::uint32_t m = 0; m < model.meshes.size(); ++m) {
      const TriMesh& mesh = model.meshes[m].surface;
      for (std::uint32_t p = 0; p < mesh.parts.size(); ++p) add_part(m, p, mesh.parts[p]);
    }
    for (std::size_t m = 0; m < reads_.size(); ++m) {
      if (is_shown_.contains(static_cast<int>(m))) continue;
      // Somebody may show it yet.
      for (const TextureRead& read : reads_[m]) is_loose_.insert(read.image);
    }
  }

  std::vector<Atlas> find() {
    DisjointSets sets(model_.images.size());
    for (const auto& [part, images] : images_of_) {
      for (const int image : images)
        sets.unite(static_cast<std::size_t>(image), static_cast<std::size_t>(*images.begin()));
    }
    std::map<std::uint32_t, Atlas> by_first;
    std::set<int> used = is_loose_;
    for (const auto& [part, images] : images_of_) used.insert(images.begin(), images.end());
    for (const int image : used) by_first[sets.find(static_cast<std::size_t>(image))].images.push_back(image);
    for (const auto& [part, images] : images_of_)
      by_first[sets.find(static_cast<std::size_t>(*images.begin()))].parts.push_back(part);
    std::vector<Atlas> atlases;
    const std::vector<ImageUse> uses = image_uses(model_);
    for (auto& [first, atlas] : by_first) {
      atlas.fixed_because = why_fixed(atlas, uses);
      atlases.push_back(std::move(atlas));
    }
    return atlases;
  }

 private:
  void add_part(std::uint32_t mesh, std::uint32_t number, const Part& part) {
    for (const int material : part_materials(model_, part)) {
      if (material < 0) continue;
      is_shown_.insert(material);
      for (const TextureRead& read : reads_[static_cast<std::size_t>(material)]) {
        const AtlasPart key{mesh, number, read.uv_set};
        images_of_[key].insert(read.image);
        if (read.is_transformed) is_transformed_.insert(read.image);
        auto& [repeats_u, repeats_v] = repeats_.try_emplace(key, true, true).first->second;
        repeats_u = repeats_u && read.wrap_u == Wrap::repeat;
        repeats_v = repeats_v && read.wrap_v == Wrap::repeat;
      }
    }
  }

  std::string why_fixed(const Atlas& atlas, const std::vector<ImageUse>& uses) const {
    for (const int image : atlas.images) {
      const auto i = static_cast<std::size_t>(image);
      const ImageInfo info = image_info(model_.images[i].bytes);
      if (info.width < 1 || info.mime_type == "image/ktx2")
        return fmt::format("image {} cannot be decoded", image);
      if (uses[i].is_ambiguous) return fmt::format("materials read image {} in different ways", image);
      if (is_transformed_.contains(image))
        return fmt::format("a transform moves the coordinates of image {}", image);
      if (is_loose_.contains(image))
        return fmt::format("a material that nothing shows reads image {}", image);
    }
    for (const AtlasPart& part : atlas.parts) {
      const std::string why = why_fixed(part);
      if (!why.empty()) return fmt::format("mesh {}, part {}: {}", part.mesh, part.part, why);
    }
    for (const AtlasFace& face : atlas_faces(model_, atlas)) {
      for (const Vec2d uv : face.uv) {
        if (!(std::abs(uv.x - 0.5) <= 0.5 + kBeyond && std::abs(uv.y - 0.5) <= 0.5 + kBeyond))
          return fmt::format("mesh {}: the image is tiled, its coordinates go on beyond it", face.mesh);
      }
    }
    return "";
  }

  std::string why_fixed(const AtlasPart& at) const {
    const TriMesh& mesh = model_.meshes[at.mesh].surface;
    if (mesh.parts[at.part].raw) return "points or lines use the image";
    const AttributeLayer* layer = mesh.find(Semantic::uv, at.uv_set);
    if (layer == nullptr) return "it has no texture coordinates";
    for (const std::vector<float>& morph : layer->morphs) {
      if (!morph.empty()) return "its texture coordinates are morphed";
    }
    const auto& [repeats_u, repeats_v] = repeats_.at(at);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      if (mesh.face_part[f] != at.part) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const ValueId id = layer->corner_value[3 * f + k];
        if (!id.valid()) return "a triangle has no texture coordinates";
        const float* uv = layer->value(id);
        const auto inside = [](float x) { return std::abs(static_cast<double>(x) - 0.5) <= 0.5 + kBeyond; };
        // Also what is not a number.
        if ((!repeats_u && !inside(uv[0])) || (!repeats_v && !inside(uv[1])))
          return "its coordinates go on beyond an image that does not repeat";
        if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) return "a texture coordinate is not a number";
      }
    }
    return "";
  }

  const Model& model_;
  std::vector<std::vector<TextureRead>> reads_;  // [#materials]
  std::map<AtlasPart, std::set<int>> images_of_;
  std::map<AtlasPart, std::pair<bool, bool>> repeats_;  // along u and v: in all images
  std::set<int> is_shown_;                              // materials
  std::set<int> is_loose_, is_transformed_;             // images
};

/// The charts of a layer: triangles connected by values, and by which repeat of the image each is off.
class Charts {
 public:
  Charts(const TriMesh& mesh, const AttributeLayer& layer) : layer_(layer), sets_(layer.size()) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const ValueId* id = &layer.corner_value[3 * f];
      if (!id[0].valid() || !id[1].valid() || !id[2].valid()) continue;
      sets_.unite(id[0].index(), id[1].index());
      sets_.unite(id[0].index(), id[2].index());
    }
    low_.resize(layer.size(),
                {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()});
    high_.resize(layer.size(),
                 {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
    for (std::size_t v = 0; v < layer.size(); ++v) {
      const std::uint32_t chart = sets_.find(v);
      const Vec2d uv = value(v);
      low_[chart] = {std::min(low_[chart].x, uv.x), std::min(low_[chart].y, uv.y)};
      high_[chart] = {std::max(high_[chart].x, uv.x), std::max(high_[chart].y, uv.y)};
    }
  }

  Vec2d value(std::size_t v) const {
    const float* uv = layer_.value(ValueId(static_cast<std::uint32_t>(v)));
    return {static_cast<double>(uv[0]), static_cast<double>(uv[1])};
  }
  /// Whole repeats of the image to the one in which the value's chart lies.
  Vec2d repeat(std::size_t v, double beyond = kBeyond) {
    const std::uint32_t chart = sets_.find(v);
    return {repeat(low_[chart].x, high_[chart].x, beyond), repeat(low_[chart].y, high_[chart].y, beyond)};
  }

 private:
  static double repeat(double low, double high, double beyond) {
    const double first = std::floor((low + high) / 2);
    return low >= first - beyond && high <= first + 1 + beyond ? first : 0;
  }

  const AttributeLayer& layer_;
  DisjointSets sets_;
  std::vector<Vec2d> low_, high_;  // of charts, at their smallest values
};

}  // namespace

std::vector<Atlas> find_atlases(const Model& model) { return Finder(model).find(); }

std::vector<AtlasFace> atlas_faces(const Model& model, const Atlas& atlas) {
  struct Layer {
    Charts charts;
    std::uint32_t first_value;
  };
  std::vector<AtlasFace> faces;
  std::map<std::pair<std::uint32_t, int>, Layer> layers;
  std::uint32_t value_count = 0;
  for (std::uint32_t p = 0; p < atlas.parts.size(); ++p) {
    const AtlasPart& part = atlas.parts[p];
    const TriMesh& mesh = model.meshes[part.mesh].surface;
    const AttributeLayer* uvs = mesh.find(Semantic::uv, part.uv_set);
    if (uvs == nullptr) continue;
    const auto [at, is_new] =
        layers.try_emplace({part.mesh, part.uv_set}, Layer{Charts(mesh, *uvs), value_count});
    if (is_new) value_count += static_cast<std::uint32_t>(uvs->size());
    Layer& layer = at->second;
    TextureUse use;
    use.uv_set = part.uv_set;
    const UvMap map(mesh, use);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
      if (mesh.face_part[f] != part.part) continue;
      const auto uv = map.triangle(f);
      if (!uv) continue;
      const ValueId* id = &uvs->corner_value[std::size_t{3} * f];
      const Vec2d repeat = layer.charts.repeat(id[0].index());
      AtlasFace& face = faces.emplace_back(AtlasFace{p, part.mesh, f, {}});
      for (std::size_t k = 0; k < 3; ++k) {
        face.uv[k] = (*uv)[k] - repeat;
        face.value[k] = layer.first_value + id[k].value;
      }
    }
  }
  return faces;
}

Model with_moved_coordinates(const Model& model, const Atlas& atlas, std::span<const AtlasFace> from,
                             std::span<const AtlasFace> to) {
  struct Layer {
    TriMesh* mesh;
    AttributeLayer* uvs;
    std::vector<bool> is_moved;  // [#corners]
    std::vector<bool> stays;     // values: other corners have them too
    std::vector<ValueId> moved;  // by old value
  };
  Model result = model;
  std::map<std::pair<std::uint32_t, int>, Layer> layers;
  const auto layer_of = [&](const AtlasFace& face) -> Layer& {
    const int set = atlas.parts[face.part].uv_set;
    const auto [at, is_new] = layers.try_emplace({face.mesh, set});
    if (is_new) {
      TriMesh& mesh = result.meshes[face.mesh].surface;
      at->second = {&mesh, mesh.find(Semantic::uv, set), {}, {}, {}};
      at->second.is_moved.resize(at->second.uvs->corner_value.size(), false);
    }
    return at->second;
  };
  for (const AtlasFace& face : from) {
    std::vector<bool>& is_moved = layer_of(face).is_moved;
    for (std::size_t k = 0; k < 3; ++k) is_moved[std::size_t{3} * face.face + k] = true;
  }
  for (auto& [key, layer] : layers) {
    layer.stays.resize(layer.uvs->size(), false);
    layer.moved.resize(layer.uvs->size());
    for (std::size_t c = 0; c < layer.is_moved.size(); ++c) {
      if (const ValueId id = layer.uvs->corner_value[c]; id.valid() && !layer.is_moved[c])
        layer.stays[id.index()] = true;
    }
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    Layer& layer = layer_of(from[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      ValueId& id = layer.uvs->corner_value[std::size_t{3} * from[i].face + k];
      ValueId& to_id = layer.moved[id.index()];
      if (!to_id.valid()) {
        to_id = layer.stays[id.index()] ? ValueId(layer.uvs->size()) : id;
        const float* const old = layer.uvs->value(id);
        const Vec2d uv =
            Vec2d{static_cast<double>(old[0]), static_cast<double>(old[1])} + to[i].uv[k] - from[i].uv[k];
        if (to_id != id)
          layer.uvs->values.resize(layer.uvs->values.size() + static_cast<std::size_t>(layer.uvs->width));
        layer.uvs->value(to_id)[0] = static_cast<float>(uv.x);
        layer.uvs->value(to_id)[1] = static_cast<float>(uv.y);
      }
      id = to_id;
    }
  }
  return result;
}

void bring_inside(Model& model, const Atlas& atlas) {
  std::map<std::pair<std::uint32_t, int>, std::set<std::uint32_t>> parts_of;
  for (const AtlasPart& part : atlas.parts) parts_of[{part.mesh, part.uv_set}].insert(part.part);
  for (const auto& [key, parts] : parts_of) {
    TriMesh& mesh = model.meshes[key.first].surface;
    AttributeLayer* layer = mesh.find(Semantic::uv, key.second);
    if (layer == nullptr) continue;
    Charts charts(mesh, *layer);
    for (std::size_t c = 0; c < layer->corner_value.size(); ++c) {
      const ValueId id = layer->corner_value[c];
      if (!id.valid() || !parts.contains(mesh.face_part[c / 3])) continue;
      const Vec2d repeat = charts.repeat(id.index(), kAstray);
      const auto inside = [](float x, double first) {
        return std::clamp(x, static_cast<float>(first), static_cast<float>(first + 1));
      };
      float* uv = layer->value(id);
      if (std::abs(static_cast<double>(uv[0]) - repeat.x - 0.5) <= 0.5 + kAstray)
        uv[0] = inside(uv[0], repeat.x);
      if (std::abs(static_cast<double>(uv[1]) - repeat.y - 0.5) <= 0.5 + kAstray)
        uv[1] = inside(uv[1], repeat.y);
    }
  }
}

}  // namespace fovea
