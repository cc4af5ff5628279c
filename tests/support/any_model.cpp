#include "support/any_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/weld.h"
#include "support/pictures.h"

namespace fovea::test {

std::uint8_t Choices::next_byte() {
  if (bytes_.empty()) return 0;
  const std::uint8_t byte = bytes_.front();
  bytes_ = bytes_.subspan(1);
  return byte;
}

std::uint32_t Choices::below(std::uint32_t bound) {
  if (!from_bytes_) return random_.below(bound);
  std::uint32_t value = next_byte();
  if (bound > 256) value = value << 8 | next_byte();
  return value % bound;
}

double Choices::between(double low, double high) {
  if (!from_bytes_) return random_.uniform(low, high);
  return low + (high - low) * next_byte() / 255.0;
}

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Points and triangles without anything on them.
struct Shape {
  std::vector<Vec3d> points;
  std::vector<std::array<std::uint32_t, 3>> faces;

  std::uint32_t size() const { return static_cast<std::uint32_t>(points.size()); }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    faces.push_back({a, b, c});
    faces.push_back({a, c, d});
  }
};

/// A sheet of columns × rows quads whose ends meet where asked for.
Shape sheet(std::uint32_t columns, std::uint32_t rows, bool wraps_u, bool wraps_v) {
  Shape shape;
  const std::uint32_t width = columns + !wraps_u, height = rows + !wraps_v;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double u = static_cast<double>(x) / columns, v = static_cast<double>(y) / rows;
      const double a = kTurn * u, b = kTurn * v;
      const double radius = wraps_v ? 1 + 0.4 * std::cos(b) : 1;
      Vec3d p{u, v, 0};
      if (wraps_u) p = {radius * std::cos(a), radius * std::sin(a), wraps_v ? 0.4 * std::sin(b) : v};
      if (!wraps_u && wraps_v) p = {u, std::cos(b), std::sin(b)};
      shape.points.push_back(p);
    }
  }
  const auto at = [&](std::uint32_t x, std::uint32_t y) { return y % height * width + x % width; };
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x)
      shape.quad(at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
  }
  return shape;
}

/// A tube closed by a fan at both ends.
Shape ball(std::uint32_t around, std::uint32_t along) {
  Shape shape = sheet(around, along, true, false);
  for (std::size_t i = 0; i < shape.points.size(); ++i) {
    const double angle = (static_cast<double>(i / around) + 1) / (along + 2) * kTurn / 2;
    Vec3d& p = shape.points[i];
    p = {p.x * std::sin(angle), p.y * std::sin(angle), -std::cos(angle)};
  }
  const std::uint32_t south = shape.size(), north = south + 1, top = along * around;
  shape.points.push_back({0, 0, -1});
  shape.points.push_back({0, 0, 1});
  for (std::uint32_t x = 0; x < around; ++x) {
    shape.faces.push_back({south, (x + 1) % around, x});
    shape.faces.push_back({north, top + x, top + (x + 1) % around});
  }
  return shape;
}

/// Triangles between any of a few points.
Shape disorder(Choices& choices) {
  Shape shape;
  for (std::uint32_t i = 4 + choices.below(12); i > 0; --i)
    shape.points.push_back({choices.between(-1, 1), choices.between(-1, 1), choices.between(-1, 1)});
  for (std::uint32_t i = 1 + choices.below(40); i > 0; --i)
    shape.faces.push_back(
        {choices.below(shape.size()), choices.below(shape.size()), choices.below(shape.size())});
  return shape;
}

void append(Shape& shape, const Shape& other, Vec3d offset) {
  const std::uint32_t first = shape.size();
  for (const Vec3d& p : other.points) shape.points.push_back(p + offset);
  for (const auto& [a, b, c] : other.faces) shape.faces.push_back({first + a, first + b, first + c});
}

Shape any_piece(Choices& choices) {
  const std::uint32_t columns = 1 + choices.below(8), rows = 1 + choices.below(6);
  switch (choices.below(6)) {
    case 0: return ball(columns + 2, rows);
    case 1: return sheet(columns + 2, rows + 2, true, true);
    case 2: return sheet(columns + 2, rows, true, false);
    case 3: return disorder(choices);
    default: return sheet(columns, rows, false, false);
  }
}

/// Triangles given twice or turned over, points moved, joined and laid flat.
void disturb(Shape& shape, Choices& choices) {
  if (choices.one_in(4)) {
    for (std::uint32_t i = 1 + choices.below(4); i > 0; --i) {
      auto face = shape.faces[choices.below(static_cast<std::uint32_t>(shape.faces.size()))];
      if (choices.one_in(2)) std::swap(face[0], face[1]);
      shape.faces.push_back(face);
    }
  }
  if (choices.one_in(3)) {
    const double most = choices.between(0, 0.5);
    for (Vec3d& p : shape.points)
      p += {choices.between(-most, most), choices.between(-most, most), choices.between(-most, most)};
  }
  if (choices.one_in(5)) {
    for (std::uint32_t i = 1 + choices.below(3); i > 0; --i)
      shape.points[choices.below(shape.size())] = shape.points[choices.below(shape.size())];
  }
  if (choices.one_in(8)) {
    for (Vec3d& p : shape.points) p.z = 0;
  }
  if (choices.one_in(16)) {
    for (Vec3d& p : shape.points) p.y = p.z = 0;
  }
}

void scale(Shape& shape, Choices& choices) {
  constexpr std::array<double, 8> kSizes{1, 1, 1, 1, 1e-30, 1e-6, 1e6, 1e30};
  const double size = kSizes[choices.below(kSizes.size())];
  const Vec3d offset = choices.one_in(8) ? Vec3d{1e5, -1e5, 1e5} : Vec3d{};
  for (Vec3d& p : shape.points) p = (p + offset) * size;
}

Shape any_shape(Choices& choices) {
  Shape shape = any_piece(choices);
  while (choices.one_in(3) && shape.faces.size() < 150)
    append(shape, any_piece(choices), {choices.between(-3, 3), choices.one_in(2) ? 0.0 : 3.0, 0});
  disturb(shape, choices);
  scale(shape, choices);
  return shape;
}

/// Which layers a mesh has, and how charts cut them.
struct Layers {
  std::uint32_t uv_sets = 0, color_width = 0, influence_sets = 0, custom_width = 0, targets = 0;
  bool normals = false, flat_normals = false, tangents = false;
  std::uint32_t charts = 1, parts = 1;
};

Layers any_layers(Choices& choices) {
  Layers layers;
  layers.uv_sets = choices.below(4) % 3;
  layers.normals = choices.one_in(2);
  layers.flat_normals = choices.one_in(3);
  layers.tangents = layers.normals && choices.one_in(4);
  if (choices.one_in(3)) layers.color_width = 3 + choices.below(2);
  if (choices.one_in(4)) layers.influence_sets = 1 + choices.below(2);
  if (choices.one_in(5)) layers.custom_width = 1 + choices.below(4);
  if (choices.one_in(4)) layers.targets = 1 + choices.below(3);
  layers.charts = choices.one_in(2) ? 1 : 1 + choices.below(5);
  layers.parts = choices.one_in(3) ? 1 + choices.below(3) : 1;
  return layers;
}

constexpr std::uint32_t kJoints = 3;

/// Makes the parts of a mesh: every triangle belongs to a part and a chart, and a point has values of its own
/// in each chart.
class PartsMaker {
 public:
  PartsMaker(const Shape& shape, const Layers& layers, Choices& choices)
      : shape_(shape), layers_(layers), choices_(choices) {}

  std::vector<SplitPart> make() {
    for (std::uint32_t p = 0; p < layers_.parts; ++p) parts_.push_back(empty_part(p));
    places_.resize(parts_.size());
    const auto faces = static_cast<std::uint32_t>(shape_.faces.size());
    const std::uint32_t run = 1 + choices_.below(20);  // triangles of a chart that follow each other
    for (std::uint32_t f = 0; f < faces; ++f) {
      const std::uint32_t chart = f / run % layers_.charts;
      const std::uint32_t part = f * layers_.parts / faces;
      for (const std::uint32_t point : shape_.faces[f])
        parts_[part].indices.push_back(vertex(part, point, layers_.flat_normals ? f : chart, chart));
    }
    return std::move(parts_);
  }

 private:
  static VertexArray array(Semantic semantic, int set, std::uint32_t width) {
    VertexArray a;
    a.semantic = semantic;
    a.set = set;
    a.width = static_cast<int>(width);
    if (semantic == Semantic::custom) a.name = "_ANY";
    if (semantic == Semantic::joints) a.storage = {ComponentType::u8, false};
    return a;
  }

  SplitPart empty_part(std::uint32_t index) const {
    SplitPart part;
    part.part.material = static_cast<int>(index) - 1;
    auto& all = part.attributes;
    for (std::uint32_t i = 0; i < layers_.uv_sets; ++i)
      all.push_back(array(Semantic::uv, static_cast<int>(i), 2));
    if (layers_.normals) all.push_back(array(Semantic::normal, 0, 3));
    if (layers_.tangents) all.push_back(array(Semantic::tangent, 0, 4));
    if (layers_.color_width > 0) all.push_back(array(Semantic::color, 0, layers_.color_width));
    for (std::uint32_t i = 0; i < layers_.influence_sets; ++i) {
      all.push_back(array(Semantic::joints, static_cast<int>(i), 4));
      all.push_back(array(Semantic::weights, static_cast<int>(i), 4));
    }
    if (layers_.custom_width > 0) all.push_back(array(Semantic::custom, 0, layers_.custom_width));
    part.position_morphs.resize(layers_.targets);
    part.attribute_morphs.resize(layers_.targets);
    for (std::uint32_t t = 0; t < layers_.targets; ++t) {
      if (layers_.normals && t == 0) part.attribute_morphs[t].push_back(array(Semantic::normal, 0, 3));
      if (layers_.uv_sets > 0 && t == 1) part.attribute_morphs[t].push_back(array(Semantic::uv, 0, 2));
    }
    return part;
  }

  std::uint32_t vertex(std::uint32_t p, std::uint32_t point, std::uint32_t side, std::uint32_t chart) {
    SplitPart& part = parts_[p];
    const auto [at, is_new] =
        places_[p].try_emplace({point, side}, static_cast<std::uint32_t>(part.positions.size()));
    if (!is_new) return at->second;
    const Vec3d position = shape_.points[point];
    part.positions.push_back(Vec3f(position));
    for (VertexArray& a : part.attributes) add_values(a, point, side, chart);
    for (std::uint32_t t = 0; t < layers_.targets; ++t) {
      // The same for all corners of a point, as targets that differ would tear it.
      const double lift = std::sin(1.0 + point + t);
      part.position_morphs[t].push_back(Vec3f(position * (0.3 * lift)));
      for (VertexArray& a : part.attribute_morphs[t])
        a.values.insert(a.values.end(), static_cast<std::size_t>(a.width), static_cast<float>(0.1 * lift));
    }
    return at->second;
  }

  void add_values(VertexArray& a, std::uint32_t point, std::uint32_t side, std::uint32_t chart) {
    std::vector<float>& out = a.values;
    const auto add = [&](double value) { out.push_back(static_cast<float>(value)); };
    switch (a.semantic) {
      case Semantic::uv:
        add(0.1 * point + chart);
        add(choices_.one_in(8) ? 0.5 : choices_.between(0, 1));
        break;
      case Semantic::normal: add_unit(out, layers_.flat_normals ? side : point); break;
      case Semantic::tangent:
        add_unit(out, point + 7);
        add(chart % 2 == 0 ? 1 : -1);
        break;
      case Semantic::color:
        for (int k = 0; k < a.width; ++k) add(choices_.between(0, 1));
        break;
      case Semantic::joints:
        for (std::uint32_t k = 0; k < 4; ++k) add((point + k) % kJoints);
        break;
      case Semantic::weights: add_weights(out, point); break;
      case Semantic::custom:
        for (int k = 0; k < a.width; ++k) add(choices_.between(-100, 100));
        break;
    }
  }

  static void add_unit(std::vector<float>& out, std::uint32_t key) {
    const double a = 1.7 * key, b = std::sin(0.9 * key);
    const double ring = std::sqrt(1 - b * b);
    for (const double x : {ring * std::cos(a), ring * std::sin(a), b}) out.push_back(static_cast<float>(x));
  }

  /// Shares that add up to one over all sets.
  void add_weights(std::vector<float>& out, std::uint32_t point) const {
    const auto sets = static_cast<float>(layers_.influence_sets);
    const float first = static_cast<float>(point % 5) / 4;
    for (const float w : {first, (1 - first) / 2, (1 - first) / 2, 0.0f}) out.push_back(w / sets);
  }

  const Shape& shape_;
  const Layers& layers_;
  Choices& choices_;
  std::vector<SplitPart> parts_;
  std::vector<std::map<std::array<std::uint32_t, 2>, std::uint32_t>>
      places_;  // split vertex of point and side
};

void add_materials(Model& model, Choices& choices) {
  model.materials.resize(2);
  model.materials[0].double_sided = choices.one_in(2);
  model.materials[1].alpha_mode = static_cast<AlphaMode>(choices.below(3));
  if (!choices.one_in(4)) return;
  EncodedImage image;
  image.mime_type = "image/png";
  image.bytes = encode_png(pattern(16, 16));
  model.images.push_back(image);
  model.textures.push_back({0, -1, "", ""});
  for (Material& material : model.materials) material.base_color = TextureRef{0, 0, {}};
}

/// Nodes that show a mesh once, often or never, as a skin if it has joints.
void show(Model& model, int mesh, bool skinned, Choices& choices) {
  constexpr std::array<double, 6> kScales{1, 1, 0.01, -1, 1000, 0};
  if (choices.one_in(12)) return;
  for (std::uint32_t i = choices.one_in(6) ? 3 : 1; i > 0; --i) {
    Node node;
    node.mesh = mesh;
    const double s = kScales[choices.below(kScales.size())];
    node.scale = {s, std::abs(s), choices.one_in(8) ? 0.001 * s : s};
    node.translation = {static_cast<double>(i), choices.between(-2, 2), 0};
    if (skinned) node.skin = 0;
    model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(std::move(node));
  }
}

void add_skin(Model& model) {
  Skin skin;
  for (std::uint32_t j = 0; j < kJoints; ++j) {
    Node joint;
    joint.translation = {0.5 * j, 0, 0};
    skin.joints.push_back(static_cast<int>(model.nodes.size()));
    model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(std::move(joint));
  }
  model.skins.push_back(std::move(skin));
}

}  // namespace

Model any_model(Choices& choices) {
  Model model;
  model.scenes.resize(1);
  model.default_scene = 0;
  add_materials(model, choices);
  add_skin(model);
  Context context;
  for (std::uint32_t m = choices.one_in(4) ? 1 + choices.below(3) : 1; m > 0; --m) {
    const Shape shape = any_shape(choices);
    const Layers layers = any_layers(choices);
    Mesh mesh;
    mesh.surface = weld(PartsMaker(shape, layers, choices).make(), context);
    mesh.morph_weights.assign(mesh.surface.target_count(), 0.0);
    show(model, static_cast<int>(model.meshes.size()), layers.influence_sets > 0, choices);
    model.meshes.push_back(std::move(mesh));
  }
  return model;
}

SimplifyOptions any_simplify_options(Choices& choices, Metric metric) {
  SimplifyOptions options;
  options.metric = metric;
  const std::uint32_t target = choices.below(5);
  if (target != 1) options.ratio = choices.between(0, 1);
  if (target == 1 || target == 2) options.triangles = choices.below(60);
  if (target == 3) options.error = choices.between(0, 0.1);
  if (target == 4) options.error_abs = choices.between(0, 1);
  if (choices.one_in(6)) options.per_mesh = true;
  if (choices.one_in(3)) options.placement = Placement::half_edge;
  if (choices.one_in(5)) {
    constexpr std::array<double, 3> kWeights{0, 1, 1e6};
    for (double* weight : {&options.uv_weight, &options.normal_weight, &options.color_weight,
                           &options.boundary_weight, &options.seam_weight})
      *weight = kWeights[choices.below(kWeights.size())];
  }
  options.lock_boundary = choices.one_in(6);
  options.keep_topology = choices.one_in(4);
  // Dozens of large views look for what is hidden: seldom, as that takes a second.
  options.cull_hidden = metric == Metric::visibility && choices.one_in(250);
  options.views.set = choices.one_in(2) ? ViewSet::tetrahedron : ViewSet::octahedron;
  options.view_size = 16 + choices.below(17);
  if (choices.one_in(3)) options.metric_from = 1 + choices.below(4);
  if (choices.one_in(2)) options.image_pass = ImagePass::base_color;
  return options;
}

Importance any_importance(Choices& choices, const Model& model) {
  Importance importance;
  if (!choices.one_in(4)) return importance;
  constexpr std::array<float, 6> kValues{1, 1, 0, 1e-6f, 1e6f, std::numeric_limits<float>::infinity()};
  for (const Mesh& mesh : model.meshes) {
    VertexField field(mesh.surface.vertex_count(), 1.0f);
    for (std::size_t v = 0; v < field.size(); ++v)
      field[VertexId{v}] = kValues[choices.below(kValues.size())];
    importance.push_back(std::move(field));
  }
  return importance;
}

}  // namespace fovea::test
