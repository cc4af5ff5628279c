#include "fovea/io/gltf_primitive_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "fovea/base/error.h"
#include "fovea/io/draco_decode.h"

namespace fovea::gltf {

namespace {

constexpr int kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;
constexpr const char* kDraco = "KHR_draco_mesh_compression";
/// Far beyond what any renderer takes; looking for names is quadratic in it.
constexpr std::size_t kMaxAttributes = 64;
/// The decoder's corner table and our indices.
constexpr std::uint64_t kDracoBytesPerIndex = 16;
/// Of a morph target, even an empty one.
constexpr std::uint64_t kBytesPerTarget = 256;

/// What an attribute's name says, and the widths that go with it.
struct AttributeKind {
  Semantic semantic = Semantic::custom;
  int set = 0;
  int min_width = 1;
  int max_width = 4;
};

struct NumberedName {
  std::string_view prefix;
  AttributeKind kind;
};
constexpr NumberedName kNumberedNames[] = {{"TEXCOORD_", {Semantic::uv, 0, 2, 2}},
                                           {"COLOR_", {Semantic::color, 0, 3, 4}},
                                           {"JOINTS_", {Semantic::joints, 0, 4, 4}},
                                           {"WEIGHTS_", {Semantic::weights, 0, 4, 4}}};

AttributeKind kind_of(std::string_view name) {
  if (name == "NORMAL") return {Semantic::normal, 0, 3, 3};
  // Targets change the direction of a tangent and leave its sign.
  if (name == "TANGENT") return {Semantic::tangent, 0, 3, 4};
  for (const NumberedName& numbered : kNumberedNames) {
    if (!name.starts_with(numbered.prefix)) continue;
    AttributeKind kind = numbered.kind;
    const char* end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data() + numbered.prefix.size(), end, kind.set);
    if (error == std::errc{} && stop == end && kind.set >= 0 && kind.set < 1000) return kind;
  }
  return {};
}

/// The decoded Draco data of a primitive, with the names of its attributes.
struct DracoData {
  DracoMesh mesh;
  std::vector<std::string> names;
};

std::optional<DracoData> read_draco(ReadState& state, const JsonView& primitive, int mode) {
  const auto extension = primitive.extension(kDraco);
  if (!extension) return std::nullopt;
  if (mode != kTriangles && mode != kTriangleStrip) extension->fail("Draco data is for triangles only");
  DracoData data;
  std::vector<DracoAttribute> wanted;
  const JsonView attributes = primitive.at("attributes");
  for (const auto& [name, id] : extension->at("attributes").members()) {
    const auto accessor = attributes.find(name.c_str());
    if (!accessor) id.fail("the primitive has no such attribute");
    const AccessorShape shape = state.data.shape(state.data.accessor_index(*accessor));
    state.budget.charge(shape.byte_size(), 1, id.place());
    wanted.push_back({static_cast<std::uint32_t>(id.integer(0, 0xFFFFFFFF)), shape});
    data.names.push_back(name);
  }
  const std::size_t max_indices = state.data.shape(state.data.accessor_index(primitive.at("indices"))).count;
  state.budget.charge(max_indices, kDracoBytesPerIndex, extension->place());
  const auto stream = state.data.view(state.data.view_index(extension->at("bufferView")));
  try {
    data.mesh = decode_draco(stream, wanted, max_indices / 3);
  } catch (const Error& e) {
    throw e.within(extension->place());
  }
  return data;
}

Accessor index_accessor(const std::vector<std::uint32_t>& indices) {
  Accessor accessor;
  accessor.storage.type = ComponentType::u32;
  accessor.count = indices.size();
  const auto bytes = std::as_bytes(std::span(indices));
  accessor.bytes.assign(bytes.begin(), bytes.end());
  return accessor;
}

Accessor read_indices(ReadState& state, const JsonView& reference) {
  Accessor indices = state.data.read(state.data.accessor_index(reference));
  const ComponentType type = indices.storage.type;
  if (indices.width != 1 ||
      (type != ComponentType::u8 && type != ComponentType::u16 && type != ComponentType::u32)) {
    reference.fail("indices are SCALAR and of an unsigned integer type");
  }
  return indices;
}

std::vector<NamedAccessor> read_attributes(ReadState& state, const JsonView& attributes, DracoData* draco) {
  std::vector<NamedAccessor> result;
  if (attributes.raw().size() > kMaxAttributes) {
    throw Error(ErrorKind::limit,
                fmt::format("{} attributes are more than {}", attributes.raw().size(), kMaxAttributes),
                attributes.place());
  }
  for (const auto& [name, reference] : attributes.members()) {
    const auto known =
        draco ? std::find(draco->names.begin(), draco->names.end(), name) : decltype(draco->names.end()){};
    if (draco && known != draco->names.end()) {
      const auto number = static_cast<std::size_t>(known - draco->names.begin());
      result.push_back({name, std::move(draco->mesh.attributes[number])});
    } else {
      result.push_back({name, state.data.read(state.data.accessor_index(reference))});
    }
  }
  return result;
}

std::size_t vertex_count(const RawPrimitive& data) {
  return data.attributes.empty() ? 0 : data.attributes.front().data.count;
}

void check_equal_counts(const std::vector<NamedAccessor>& attributes, std::size_t count, const JsonView& at) {
  for (const NamedAccessor& a : attributes) {
    if (a.data.count == count) continue;
    at.at(a.name.c_str()).fail(fmt::format("{} values for {} vertices", a.data.count, count));
  }
}

void check_indices(const RawPrimitive& data, const JsonView& primitive) {
  if (!data.indices) return;
  const std::size_t count = vertex_count(data);
  const std::vector<std::uint32_t> indices = to_indices(*data.indices);
  const auto bad = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= count; });
  if (bad == indices.end()) return;
  const JsonView at = primitive.find("indices").value_or(primitive);
  at.fail(fmt::format("index {} is {} but there are {} vertices", bad - indices.begin(), *bad, count));
}

/// Calls `f` with the corners of every triangle; strips alternate so that all have the same side out.
template <class F>
void for_each_triangle(int mode, std::size_t corners, F&& f) {
  if (mode == kTriangles) {
    for (std::size_t i = 0; i + 2 < corners; i += 3) f(i, i + 1, i + 2);
  } else if (mode == kTriangleStrip) {
    for (std::size_t i = 0; i + 2 < corners; ++i) f(i, i + 1 + i % 2, i + 2 - i % 2);
  } else {
    for (std::size_t i = 0; i + 2 < corners; ++i) f(i + 1, i + 2, 0);
  }
}

std::vector<std::uint32_t> triangle_indices(ReadState& state, const JsonView& primitive,
                                            const RawPrimitive& data) {
  std::vector<std::uint32_t> given;
  if (data.indices) given = to_indices(*data.indices);
  const std::size_t corners = data.indices ? given.size() : vertex_count(data);
  if (corners == 0) return {};
  if (corners < 3 || (data.mode == kTriangles && corners % 3 != 0)) {
    state.context.report("incomplete-triangles", "corners that do not make a whole triangle were dropped",
                         primitive.place());
  }
  state.budget.charge(corners, 3 * sizeof(std::uint32_t), primitive.place());
  std::vector<std::uint32_t> indices;
  for_each_triangle(data.mode, corners, [&](std::size_t a, std::size_t b, std::size_t c) {
    for (const std::size_t corner : {a, b, c}) {
      indices.push_back(data.indices ? given[corner] : static_cast<std::uint32_t>(corner));
    }
  });
  return indices;
}

std::vector<Vec3f> to_points(const std::vector<float>& values) {
  std::vector<Vec3f> points(values.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return points;
}

void expect_width(const Accessor& accessor, int low, int high, const JsonView& at) {
  if (accessor.matrix || accessor.width < low || accessor.width > high) {
    at.fail(fmt::format("{} components where {} are expected", accessor.width,
                        low == high ? std::to_string(low) : fmt::format("{} or {}", low, high)));
  }
}

std::vector<Vec3f> read_positions(ReadState& state, const Accessor& accessor, const JsonView& at) {
  expect_width(accessor, 3, 3, at);
  state.budget.charge(accessor.count, 2 * sizeof(Vec3f), at.place());
  const std::vector<float> values = accessor.to_floats();
  const auto bad = std::find_if(values.begin(), values.end(), [](float x) { return !std::isfinite(x); });
  if (bad != values.end())
    at.fail(fmt::format("the position of vertex {} is not finite", (bad - values.begin()) / 3));
  return to_points(values);
}

/// The arrays of a primitive or of a morph target but for the positions.
std::vector<VertexArray> read_arrays(ReadState& state, const std::vector<NamedAccessor>& attributes,
                                     const JsonView& at) {
  std::vector<VertexArray> arrays;
  for (const NamedAccessor& attribute : attributes) {
    if (attribute.name == "POSITION") continue;
    const JsonView place = at.at(attribute.name.c_str());
    const AttributeKind kind = kind_of(attribute.name);
    if (kind.semantic == Semantic::custom && attribute.data.matrix) {
      state.context.report("attribute-dropped", "vertex attributes that are matrices are not kept",
                           place.place());
      continue;
    }
    expect_width(attribute.data, kind.min_width, kind.max_width, place);
    VertexArray array;
    array.semantic = kind.semantic;
    array.set = kind.set;
    if (kind.semantic == Semantic::custom) array.name = attribute.name;
    array.width = attribute.data.width;
    array.storage = attribute.data.storage;
    array.values = state.finite_floats(attribute.data, place);
    arrays.push_back(std::move(array));
  }
  return arrays;
}

const Accessor* find_attribute(const std::vector<NamedAccessor>& attributes, std::string_view name) {
  for (const NamedAccessor& a : attributes) {
    if (a.name == name) return &a.data;
  }
  return nullptr;
}

void read_targets(ReadState& state, const JsonView& primitive, const RawPrimitive& data, SplitPart& part) {
  const std::vector<JsonView> targets = primitive.elements("targets");
  for (std::size_t t = 0; t < data.targets.size(); ++t) {
    state.budget.charge(1, kBytesPerTarget, targets[t].place());
    part.attribute_morphs.push_back(read_arrays(state, data.targets[t], targets[t]));
    const Accessor* positions = find_attribute(data.targets[t], "POSITION");
    if (positions) {
      const JsonView at = targets[t].at("POSITION");
      expect_width(*positions, 3, 3, at);
      part.position_morphs.push_back(to_points(state.finite_floats(*positions, at)));
    } else {
      state.budget.charge(part.positions.size(), sizeof(Vec3f), targets[t].place());
      part.position_morphs.emplace_back(part.positions.size());
    }
  }
}

}  // namespace

RawPrimitive read_primitive_data(ReadState& state, const JsonView& primitive) {
  RawPrimitive data;
  data.mode = static_cast<int>(primitive.integer("mode", 0, kTriangleFan, kTriangles));
  const JsonView attributes = primitive.at("attributes");
  auto draco = read_draco(state, primitive, data.mode);
  data.attributes = read_attributes(state, attributes, draco ? &*draco : nullptr);
  const std::size_t count = draco ? draco->mesh.vertex_count : vertex_count(data);
  check_equal_counts(data.attributes, count, attributes);
  if (draco) {
    data.mode = kTriangles;
    data.indices = index_accessor(draco->mesh.indices);
  } else if (const auto indices = primitive.find("indices")) {
    data.indices = read_indices(state, *indices);
  }
  check_indices(data, primitive);
  for (const JsonView& target : primitive.elements("targets")) {
    data.targets.push_back(read_attributes(state, target, nullptr));
    check_equal_counts(data.targets.back(), count, target);
  }
  return data;
}

SplitPart to_split_part(ReadState& state, const JsonView& primitive, const RawPrimitive& data) {
  SplitPart part;
  const JsonView attributes = primitive.at("attributes");
  const Accessor* positions = find_attribute(data.attributes, "POSITION");
  if (!positions) {
    state.context.report("no-positions", "a primitive without POSITION has nothing to show",
                         primitive.place());
    return part;
  }
  part.positions = read_positions(state, *positions, attributes.at("POSITION"));
  part.position_storage = positions->storage;
  part.indices = triangle_indices(state, primitive, data);
  part.attributes = read_arrays(state, data.attributes, attributes);
  read_targets(state, primitive, data, part);
  return part;
}

}  // namespace fovea::gltf
