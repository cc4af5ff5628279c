#include "fovea/io/indexed_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "fovea/base/error.h"
#include "fovea/io/byte_budget.h"
#include "fovea/model/key_table.h"

namespace fovea {

namespace {

/// Vec3f over a plain array of floats.
Vec3f get(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}
void put(std::vector<float>& values, std::size_t i, Vec3f v) {
  values[3 * i] = v.x;
  values[3 * i + 1] = v.y;
  values[3 * i + 2] = v.z;
}

/// Triangles by the positions and by the normals of their corners [#triangles × 3].
struct TriangleRun {
  std::span<const std::uint32_t> positions, normals;
};

/// Gives all normals length 1; those without a direction get the mean of their triangles'.
void repair_normals(std::vector<float>& normals, std::span<const Vec3f> positions,
                    std::span<const TriangleRun> runs, Context& context, const std::string& place) {
  std::vector<std::uint8_t> bad(normals.size() / 3, 0);
  std::uint64_t bad_count = 0;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const Vec3d n(get(normals, i));
    const double l = length(n);
    bad[i] = !(l > 0) || !std::isfinite(l);
    bad_count += bad[i];
    put(normals, i, bad[i] ? Vec3f{} : Vec3f(n / l));
  }
  if (bad_count == 0) return;
  context.report("bad-normals", "normals without a direction were made anew", place, bad_count);
  for (const TriangleRun& run : runs) {
    for (std::size_t c = 0; c < run.normals.size(); ++c) {
      if (!bad[run.normals[c]]) continue;
      const auto corner = [&](std::size_t k) { return Vec3d(positions[run.positions[c - c % 3 + k]]); };
      const Vec3d n = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
      put(normals, run.normals[c], get(normals, run.normals[c]) + Vec3f(n));
    }
  }
  for (std::size_t i = 0; i < bad.size(); ++i) {
    if (!bad[i]) continue;
    const Vec3f n = normalized(get(normals, i));
    put(normals, i, length_squared(n) > 0.5f ? n : Vec3f{0, 0, 1});
  }
}

void repair_normals(IndexedMesh& mesh, Context& context, const std::string& place) {
  std::vector<TriangleRun> own, shared;
  for (const IndexedMesh::Group& group : mesh.groups) {
    own.push_back({group.positions, group.normals});
    shared.push_back({group.positions, group.positions});
  }
  std::vector<float> table;
  for (const Vec3f& n : mesh.normals) table.insert(table.end(), {n.x, n.y, n.z});
  repair_normals(table, mesh.positions, own, context, place);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) mesh.normals[i] = get(table, i);
  for (VertexArray& a : mesh.attributes) {
    if (a.semantic == Semantic::normal) repair_normals(a.values, mesh.positions, shared, context, place);
  }
}

/// What makes a split vertex: which entry of each table it takes.
struct SplitKey {
  std::uint32_t position, uv, normal;
};

VertexArray empty_array(Semantic semantic, int width) {
  VertexArray array;
  array.semantic = semantic;
  array.width = width;
  return array;
}

/// The split vertices of a group in order of first use, and its triangles over them.
std::vector<SplitKey> split_corners(const IndexedMesh::Group& group, std::vector<std::uint32_t>& indices) {
  KeyTable table(3, group.positions.size() / 5);
  std::vector<SplitKey> keys;
  indices.reserve(group.positions.size());
  for (std::size_t c = 0; c < group.positions.size(); ++c) {
    const SplitKey key{group.positions[c], group.uvs.empty() ? kInvalid : group.uvs[c],
                       group.normals.empty() ? kInvalid : group.normals[c]};
    const std::uint32_t index = table.insert(std::array{key.position, key.uv, key.normal});
    if (index == keys.size()) keys.push_back(key);
    indices.push_back(index);
  }
  return keys;
}

VertexArray gather_uvs(const IndexedMesh& mesh, const std::vector<SplitKey>& keys) {
  VertexArray array = empty_array(Semantic::uv, 2);
  for (const SplitKey& key : keys) {
    const Vec2f uv = mesh.uvs[key.uv];
    array.values.insert(array.values.end(), {uv.x, uv.y});
  }
  return array;
}

VertexArray gather_normals(const IndexedMesh& mesh, const std::vector<SplitKey>& keys) {
  VertexArray array = empty_array(Semantic::normal, 3);
  for (const SplitKey& key : keys) {
    const Vec3f n = mesh.normals[key.normal];
    array.values.insert(array.values.end(), {n.x, n.y, n.z});
  }
  return array;
}

VertexArray gather(const VertexArray& from, const std::vector<SplitKey>& keys) {
  VertexArray array = empty_array(from.semantic, from.width);
  array.set = from.set;
  array.name = from.name;
  array.storage = from.storage;
  for (const SplitKey& key : keys) {
    const float* value =
        from.values.data() + std::size_t{key.position} * static_cast<std::size_t>(from.width);
    array.values.insert(array.values.end(), value, value + from.width);
  }
  return array;
}

SplitPart split_group(const IndexedMesh& mesh, const IndexedMesh::Group& group,
                      std::vector<std::uint32_t>& position_of_split) {
  SplitPart part;
  part.part.material = group.material;
  const std::vector<SplitKey> keys = split_corners(group, part.indices);
  for (const SplitKey& key : keys) {
    part.positions.push_back(mesh.positions[key.position]);
    position_of_split.push_back(key.position);
  }
  if (!group.uvs.empty()) part.attributes.push_back(gather_uvs(mesh, keys));
  if (!group.normals.empty()) part.attributes.push_back(gather_normals(mesh, keys));
  for (const VertexArray& from : mesh.attributes) part.attributes.push_back(gather(from, keys));
  return part;
}

/// With one group and no tables of its own the vertices of the file are the split vertices.
TriMesh weld_plain(IndexedMesh&& mesh, Context& context, const std::string& place) {
  SplitPart part;
  part.part.material = mesh.groups[0].material;
  part.positions = std::move(mesh.positions);
  part.indices = std::move(mesh.groups[0].positions);
  part.attributes = std::move(mesh.attributes);
  return weld({&part, 1}, context, place);
}

TriMesh weld_groups(IndexedMesh&& mesh, Context& context, const std::string& place) {
  std::vector<SplitPart> parts;
  std::vector<std::uint32_t> position_of_split;
  for (IndexedMesh::Group& group : mesh.groups) {
    parts.push_back(split_group(mesh, group, position_of_split));
    group = {};
  }
  const std::size_t source_count = mesh.positions.size();
  TriMesh result = weld(parts, context, place);
  std::vector<VertexId> source(source_count);
  for (std::size_t i = 0; i < position_of_split.size(); ++i) {
    source[position_of_split[i]] = result.source_vertex[i];
  }
  result.source_vertex = std::move(source);
  return result;
}

/// The texture coordinate sets that each part's triangles have; none for parts without triangles.
std::vector<std::optional<std::set<int>>> uv_sets_of_parts(const TriMesh& mesh) {
  std::vector<std::optional<std::set<int>>> sets(mesh.parts.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t part = mesh.face_part[f];
    if (sets[part]) continue;
    sets[part].emplace();
    for (const AttributeLayer& layer : mesh.layers) {
      if (layer.semantic == Semantic::uv && layer.corner_value[3 * f].valid()) sets[part]->insert(layer.set);
    }
  }
  return sets;
}

constexpr std::array kMaps = {&Material::base_color, &Material::metallic_roughness, &Material::normal,
                              &Material::occlusion, &Material::emissive};

Material without_textures(const Material& material, const std::set<int>& uv_sets) {
  Material result = material;
  for (const auto map : kMaps) {
    if (result.*map && !uv_sets.contains((result.*map)->uv_set)) (result.*map).reset();
  }
  return result;
}

bool same_textures(const Material& a, const Material& b) {
  return std::all_of(kMaps.begin(), kMaps.end(), [&](auto map) { return a.*map == b.*map; });
}

}  // namespace

void repair_normals(SplitPart& part, Context& context, const std::string& place) {
  const TriangleRun run{part.indices, part.indices};
  for (VertexArray& a : part.attributes) {
    if (a.semantic == Semantic::normal) repair_normals(a.values, part.positions, {&run, 1}, context, place);
  }
}

std::size_t IndexedMesh::triangle_count() const {
  std::size_t count = 0;
  for (const Group& group : groups) count += group.positions.size() / 3;
  return count;
}

std::uint64_t IndexedMesh::byte_count() const {
  std::uint64_t numbers = 3 * positions.size() + 2 * uvs.size() + 3 * normals.size();
  for (const VertexArray& a : attributes) numbers += a.values.size();
  for (const Group& g : groups) numbers += g.positions.size() + g.uvs.size() + g.normals.size();
  return 4 * numbers;
}

TriMesh weld(IndexedMesh&& mesh, const ReadOptions& options, Context& context, const std::string& place) {
  ByteBudget(options.max_total_bytes).charge(mesh.byte_count(), 1, place);
  if (mesh.triangle_count() == 0) {
    throw Error(ErrorKind::unsupported, "the file has no triangles", place,
                "point clouds and curves have no surface to simplify");
  }
  repair_normals(mesh, context, place);
  const bool plain = mesh.groups.size() == 1 && mesh.groups[0].uvs.empty() && mesh.groups[0].normals.empty();
  return plain ? weld_plain(std::move(mesh), context, place) : weld_groups(std::move(mesh), context, place);
}

Model model_of(TriMesh&& surface, const std::string& name) {
  Model model;
  model.meshes.push_back({name, std::move(surface), {}, {}});
  Node node;
  node.name = name;
  node.mesh = 0;
  model.nodes.push_back(std::move(node));
  model.scenes.push_back({name, {0}, {}});
  model.default_scene = 0;
  return model;
}

void drop_textures_without_uvs(Model& model) {
  std::map<std::pair<int, std::set<int>>, int> copies;  // of a material, by the uv sets that it may use
  for (Mesh& mesh : model.meshes) {
    const auto sets = uv_sets_of_parts(mesh.surface);
    for (std::size_t p = 0; p < sets.size(); ++p) {
      int& material = mesh.surface.parts[p].material;
      if (material < 0 || !sets[p]) continue;
      Material bare = without_textures(model.materials[static_cast<std::size_t>(material)], *sets[p]);
      const auto next = static_cast<int>(model.materials.size());
      if (same_textures(bare, model.materials[static_cast<std::size_t>(material)])) continue;
      const auto [known, is_new] = copies.try_emplace({material, *sets[p]}, next);
      if (is_new) model.materials.push_back(std::move(bare));
      material = known->second;
    }
  }
}

void check_element_count(std::uint64_t count, const char* what, const ReadOptions& options,
                         const std::string& place) {
  const auto limit = static_cast<std::uint64_t>(options.max_elements);
  if (count <= limit && count < kInvalid) return;
  throw Error(ErrorKind::limit, fmt::format("{} {} are more than {}", count, what, limit), place,
              "raise --max-elements");
}

}  // namespace fovea
