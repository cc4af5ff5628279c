#include "support/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "fovea/base/context.h"
#include "fovea/base/random.h"

namespace fovea::test {

namespace {

constexpr double kPi = std::numbers::pi;

/// Calls `f(column, row)` for the (columns + 1) × (rows + 1) points of a grid, row by row.
template <class F>
void for_grid_points(int columns, int rows, F&& f) {
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) f(column, row);
  }
}

/// Quads over points numbered as by `for_grid_points`, starting at `first`.
void add_grid_quads(PartBuilder& builder, int columns, int rows, std::uint32_t first = 0) {
  const std::uint32_t stride = static_cast<std::uint32_t>(columns) + 1;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t a =
          first + static_cast<std::uint32_t>(row) * stride + static_cast<std::uint32_t>(column);
      builder.quad(a, a + 1, a + 1 + stride, a + stride);
    }
  }
}

Vec3f point(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}
Vec2f texel(double u, double v) { return {static_cast<float>(u), static_cast<float>(v)}; }

double fraction(int i, int n) { return static_cast<double>(i) / n; }

VertexArray array(Semantic semantic, int width, std::vector<float> values, Storage storage = {}) {
  VertexArray a;
  a.semantic = semantic;
  a.width = width;
  a.storage = storage;
  a.values = std::move(values);
  return a;
}

void append(std::vector<float>& values, std::initializer_list<float> more) {
  values.insert(values.end(), more);
}

/// Columns [from, to] of the unit grid with `columns` columns.
SplitPart grid_columns(int from, int to, int columns, int rows, int material) {
  PartBuilder builder(material, true, true);
  for_grid_points(to - from, rows, [&](int i, int row) {
    const double x = fraction(from + i, columns), y = fraction(row, rows);
    builder.vertex(point(x, y, 0), texel(x, y));
  });
  add_grid_quads(builder, to - from, rows);
  return builder.part();
}

/// Strip of quads along x from 0 to `quads`, y 0 and `height`.
PartBuilder strip(int quads, double height) {
  PartBuilder builder(-1, true, true);
  for_grid_points(quads, 1, [&](int column, int row) {
    builder.vertex(point(column, row * height, 0), texel(fraction(column, quads), row));
  });
  add_grid_quads(builder, quads, 1);
  return builder;
}

void add_tetrahedron(PartBuilder& builder, Vec3f corner, float size) {
  const std::uint32_t o = builder.vertex(corner);
  const std::uint32_t x = builder.vertex(corner + Vec3f{size, 0, 0});
  const std::uint32_t y = builder.vertex(corner + Vec3f{0, size, 0});
  const std::uint32_t z = builder.vertex(corner + Vec3f{0, 0, size});
  builder.triangle(o, y, x);
  builder.triangle(o, x, z);
  builder.triangle(o, z, y);
  builder.triangle(x, y, z);
}

}  // namespace

PartBuilder::PartBuilder(int material, bool with_uv, bool with_normals) {
  part_.part.material = material;
  if (with_uv) part_.attributes.push_back(array(Semantic::uv, 2, {}));
  if (with_normals) part_.attributes.push_back(array(Semantic::normal, 3, {}));
}

std::uint32_t PartBuilder::vertex(Vec3f position, Vec2f uv, Vec3f normal) {
  part_.positions.push_back(position);
  for (VertexArray& a : part_.attributes) {
    if (a.semantic == Semantic::uv) append(a.values, {uv.x, uv.y});
    if (a.semantic == Semantic::normal) append(a.values, {normal.x, normal.y, normal.z});
  }
  return size() - 1;
}

void PartBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  part_.indices.insert(part_.indices.end(), {a, b, c});
}

void PartBuilder::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

TriMesh weld_parts(std::vector<SplitPart> parts) {
  Context context;
  return weld(parts, context);
}

TriMesh weld_part(SplitPart part) { return weld_parts({std::move(part)}); }

TriMesh empty_mesh() { return weld_parts({}); }

//   2
//   | \          uv = (x, y)
//   0--1
TriMesh single_triangle() {
  PartBuilder builder;
  builder.vertex({0, 0, 0}, {0, 0});
  builder.vertex({1, 0, 0}, {1, 0});
  builder.vertex({0, 1, 0}, {0, 1});
  builder.triangle(0, 1, 2);
  return weld_part(builder.part());
}

//   z
//   |  y
//   | /
//   o----x       the corner of a box, closed by the triangle x y z
TriMesh tetrahedron() { return tetrahedra(1); }

TriMesh tetrahedra(int count) {
  PartBuilder builder(-1, false);
  for (int i = 0; i < count; ++i) {
    add_tetrahedron(builder, {2.0f * static_cast<float>(i), 0, 0}, std::ldexp(1.0f, -i));
  }
  return weld_part(builder.part());
}

//       +---+
//      /   /|    six sides; per side its chart in a row of six,
//     +---+ +    its four vertices of its own and its normal
//     |   |/
//     +---+
TriMesh cube() {
  PartBuilder builder(0, true, true);
  const std::array<std::array<Vec3f, 2>, 6> sides{{{Vec3f{0, 1, 0}, Vec3f{0, 0, 1}},
                                                   {Vec3f{0, 0, 1}, Vec3f{0, 1, 0}},
                                                   {Vec3f{0, 0, 1}, Vec3f{1, 0, 0}},
                                                   {Vec3f{1, 0, 0}, Vec3f{0, 0, 1}},
                                                   {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}},
                                                   {Vec3f{0, 1, 0}, Vec3f{1, 0, 0}}}};
  for (std::size_t side = 0; side < sides.size(); ++side) {
    const auto [right, up] = sides[side];
    const Vec3f normal = cross(right, up);
    const float u = static_cast<float>(side) / 6, u_end = static_cast<float>(side + 1) / 6 - 0.01f;
    const std::uint32_t a = builder.vertex(normal - right - up, {u, 0}, normal);
    const std::uint32_t b = builder.vertex(normal + right - up, {u_end, 0}, normal);
    const std::uint32_t c = builder.vertex(normal + right + up, {u_end, 1}, normal);
    const std::uint32_t d = builder.vertex(normal - right + up, {u, 1}, normal);
    builder.quad(a, b, c, d);
  }
  return weld_part(builder.part());
}

//   6--7--8
//   | /| /|      columns 2, rows 2; all diagonals run the same way
//   3--4--5
//   | /| /|
//   0--1--2
TriMesh grid(int columns, int rows) { return weld_part(grid_columns(0, columns, columns, rows, -1)); }

TriMesh wavy_grid(int columns, int rows, double amplitude) {
  PartBuilder builder(-1, true, true);
  for_grid_points(columns, rows, [&](int column, int row) {
    const double x = fraction(column, columns), y = fraction(row, rows);
    const double sx = std::sin(2 * kPi * x), sy = std::sin(2 * kPi * y);
    const double dx = 2 * kPi * amplitude * std::cos(2 * kPi * x) * sy;
    const double dy = 2 * kPi * amplitude * sx * std::cos(2 * kPi * y);
    builder.vertex(point(x, y, amplitude * sx * sy), texel(x, y), Vec3f(normalized(Vec3d{-dx, -dy, 1})));
  });
  add_grid_quads(builder, columns, rows);
  return weld_part(builder.part());
}

//   +--+--*--+--+
//   |  0  *  1  |    parts 0 and 1 have the vertices * each
//   +--+--*--+--+
TriMesh two_part_grid(int columns, int rows) {
  return weld_parts(
      {grid_columns(0, columns / 2, columns, rows, 0), grid_columns(columns / 2, columns, columns, rows, 1)});
}

//    u=0|1
//   .--+--.      the last column repeats the positions of the first
//   |  |  |      bit by bit, with u = 1 instead of 0
//   '--+--'
TriMesh open_cylinder(int around, int along) {
  PartBuilder builder(-1, true, true);
  for_grid_points(around, along, [&](int column, int row) {
    const double angle = 2 * kPi * fraction(column % around, around);
    const double x = std::cos(angle), y = std::sin(angle);
    builder.vertex(point(x, y, 2 * fraction(row, along)),
                   texel(fraction(column, around), fraction(row, along)), point(x, y, 0));
  });
  add_grid_quads(builder, around, along);
  return weld_part(builder.part());
}

namespace {

struct Ball {
  std::vector<Vec3d> points;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

Ball icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Ball ball{{{-1, g, 0},
             {1, g, 0},
             {-1, -g, 0},
             {1, -g, 0},
             {0, -1, g},
             {0, 1, g},
             {0, -1, -g},
             {0, 1, -g},
             {g, 0, -1},
             {g, 0, 1},
             {-g, 0, -1},
             {-g, 0, 1}},
            {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (Vec3d& p : ball.points) p = normalized(p);
  return ball;
}

//      a
//     / \        each triangle in four
//    x---z
//   / \ / \.
//  b---y---c
Ball subdivide(const Ball& coarse) {
  Ball fine{coarse.points, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.points.size()));
    if (is_new) fine.points.push_back(normalized(coarse.points[a] + coarse.points[b]));
    return at->second;
  };
  for (const auto& [a, b, c] : coarse.faces) {
    const std::uint32_t x = middle(a, b), y = middle(b, c), z = middle(c, a);
    for (const auto& face : {std::array{a, x, z}, {x, b, y}, {z, y, c}, {x, y, z}})
      fine.faces.push_back(face);
  }
  return fine;
}

}  // namespace

TriMesh icosphere(int subdivisions) {
  Ball ball = icosahedron();
  for (int i = 0; i < subdivisions; ++i) ball = subdivide(ball);
  PartBuilder builder(-1, false, true);
  for (const Vec3d& p : ball.points) builder.vertex(Vec3f(p), {}, Vec3f(p));
  for (const auto& [a, b, c] : ball.faces) builder.triangle(a, b, c);
  return weld_part(builder.part());
}

TriMesh torus(int around, int across) {
  PartBuilder builder(-1, true, true);
  constexpr double kMajor = 1.0, kMinor = 0.4;
  for_grid_points(around, across, [&](int column, int row) {
    const double a = 2 * kPi * fraction(column % around, around);
    const double b = 2 * kPi * fraction(row % across, across);
    const Vec3d normal{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
    const Vec3d ring{std::cos(a) * kMajor, std::sin(a) * kMajor, 0};
    builder.vertex(Vec3f(ring + normal * kMinor), texel(fraction(column, around), fraction(row, across)),
                   Vec3f(normal));
  });
  add_grid_quads(builder, around, across);
  return weld_part(builder.part());
}

//   u: 0  .5  1  .5  0
//      +--+--+--+--+
//      |  |  |  |  |
//      +--+--+--+--+
TriMesh mirrored_strip(int half) {
  PartBuilder builder(-1, true, true);
  for_grid_points(2 * half, 1, [&](int column, int row) {
    builder.vertex(point(column, row, 0), texel(1 - fraction(std::abs(column - half), half), row));
  });
  add_grid_quads(builder, 2 * half, 1);
  return weld_part(builder.part());
}

//   1     4
//   |\   /|
//   | \ / |
//   |  0  |
//   | / \ |
//   |/   \|
//   2     3
TriMesh bow_tie() {
  PartBuilder builder;
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{-1, 1, 0}, Vec3f{-1, -1, 0}, Vec3f{1, -1, 0}, Vec3f{1, 1, 0}}) {
    builder.vertex(p, {p.x, p.y});
  }
  builder.triangle(0, 1, 2);
  builder.triangle(0, 3, 4);
  return weld_part(builder.part());
}

//      4
//      |         the edge 0-1 seen from its end: the triangles
//   2--0--3      to 2 and 3 agree, the one to 4 is the third
TriMesh non_manifold_edge() {
  PartBuilder builder;
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{0, 1, 0}, Vec3f{-1, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 0, 1}}) {
    builder.vertex(p, {p.x + p.z, p.y});
  }
  builder.triangle(0, 1, 2);
  builder.triangle(1, 0, 3);
  builder.triangle(0, 1, 4);
  return weld_part(builder.part());
}

//   2--1
//   | /|         0 1 2 and 0 1 3: both run from 0 to 1
//   0--3
TriMesh inconsistent_edge() {
  PartBuilder builder;
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}, Vec3f{1, 0, 0}}) {
    builder.vertex(p, {p.x, p.y});
  }
  builder.triangle(0, 1, 2);
  builder.triangle(0, 1, 3);
  return weld_part(builder.part());
}

//   2
//   | \          3 lies on 1 bit by bit
//   0--1=3
SplitPart degenerate_part() {
  PartBuilder builder;
  builder.vertex({0, 0, 0}, {0, 0});
  builder.vertex({1, 0, 0}, {1, 0});
  builder.vertex({0, 1, 0}, {0, 1});
  builder.vertex({1, 0, 0}, {0.5f, 0});
  builder.triangle(0, 1, 2);
  builder.triangle(0, 0, 2);
  builder.triangle(1, 3, 2);
  return builder.part();
}

TriMesh duplicate_faces() {
  PartBuilder builder;
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}}) builder.vertex(p, {p.x, p.y});
  builder.triangle(0, 1, 2);
  builder.triangle(0, 1, 2);
  return weld_part(builder.part());
}

TriMesh two_sided_triangle() {
  PartBuilder builder;
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}}) builder.vertex(p, {p.x, p.y});
  builder.triangle(0, 1, 2);
  builder.triangle(2, 1, 0);
  return weld_part(builder.part());
}

//   +--+--+--+
//   |  |  |  |   weights (1, 0) at the left end, (0, 1) at the right one
//   +--+--+--+
TriMesh skinned_strip(int quads) {
  SplitPart part = strip(quads, 1).part();
  std::vector<float> joints, weights;
  for_grid_points(quads, 1, [&](int column, int) {
    const float w = static_cast<float>(fraction(column, quads));
    append(joints, {0, 1, 0, 0});
    append(weights, {1 - w, w, 0, 0});
  });
  part.attributes.push_back(array(Semantic::joints, 4, joints, {ComponentType::u8, false}));
  part.attributes.push_back(array(Semantic::weights, 4, weights));
  return weld_part(std::move(part));
}

//          .+    target 0 bends the strip up, z += x² / quads
//      .--'
//   +--+--+--+   target 1 lets the texture slide, u += 0.1
TriMesh morph_strip(int quads) {
  SplitPart part = strip(quads, 1).part();
  std::vector<Vec3f> lift;
  std::vector<float> tilt, slide;
  for_grid_points(quads, 1, [&](int column, int) {
    lift.push_back(point(0, 0, fraction(column * column, quads)));
    const Vec3f normal(normalized(Vec3d{-2 * fraction(column, quads), 0, 1}));
    append(tilt, {normal.x, 0, normal.z - 1});
    append(slide, {0.1f, 0});
  });
  part.position_morphs = {lift, {}};
  part.attribute_morphs = {{array(Semantic::normal, 3, tilt)}, {array(Semantic::uv, 2, slide)}};
  return weld_part(std::move(part));
}

TriMesh sliver_strip(int quads) { return weld_part(strip(quads, 1e-7 * quads).part()); }

std::vector<NamedMesh> all_families() {
  return {{"empty", empty_mesh()},
          {"single_triangle", single_triangle()},
          {"tetrahedron", tetrahedron()},
          {"tetrahedra", tetrahedra(4)},
          {"cube", cube()},
          {"grid", grid(7, 5)},
          {"wavy_grid", wavy_grid(9, 8, 0.1)},
          {"two_part_grid", two_part_grid(6, 4)},
          {"open_cylinder", open_cylinder(12, 5)},
          {"icosphere", icosphere(2)},
          {"torus", torus(12, 8)},
          {"mirrored_strip", mirrored_strip(4)},
          {"bow_tie", bow_tie()},
          {"non_manifold_edge", non_manifold_edge()},
          {"inconsistent_edge", inconsistent_edge()},
          {"degenerate", weld_part(degenerate_part())},
          {"duplicate_faces", duplicate_faces()},
          {"two_sided_triangle", two_sided_triangle()},
          {"skinned_strip", skinned_strip(6)},
          {"morph_strip", morph_strip(6)},
          {"sliver_strip", sliver_strip(6)}};
}

Model model_of(std::vector<TriMesh> meshes) {
  Model model;
  Scene scene;
  int materials = 0;
  for (TriMesh& surface : meshes) {
    for (const Part& part : surface.parts) materials = std::max(materials, part.material + 1);
    Mesh mesh;
    mesh.surface = std::move(surface);
    mesh.morph_weights.assign(mesh.surface.target_count(), 0.0);
    Node node;
    node.mesh = static_cast<int>(model.meshes.size());
    scene.nodes.push_back(static_cast<int>(model.nodes.size()));
    model.meshes.push_back(std::move(mesh));
    model.nodes.push_back(std::move(node));
  }
  model.materials.resize(static_cast<std::size_t>(materials));
  model.scenes = {std::move(scene)};
  model.default_scene = 0;
  return model;
}

Model model_of(TriMesh mesh) {
  std::vector<TriMesh> meshes;
  meshes.push_back(std::move(mesh));
  return model_of(std::move(meshes));
}

//   node 0 (the strip) · node 1 (joint at x = 0) -> node 2 (joint at x = quads / 2)
Model skinned_model(int quads) {
  Model model = model_of(skinned_strip(quads));
  const float middle = static_cast<float>(quads) / 2;
  Node root, tip;
  root.children = {2};
  tip.translation = {middle, 0, 0};
  model.nodes.insert(model.nodes.end(), {root, tip});
  model.nodes[0].skin = 0;
  model.scenes[0].nodes = {0, 1};

  Skin skin;
  skin.joints = {1, 2};
  skin.inverse_bind = Accessor::from_floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -middle, 0, 0, 1},
      16);
  skin.inverse_bind->matrix = true;
  model.skins = {skin};

  AnimationSampler sampler;
  sampler.input = Accessor::from_floats({0, 1}, 1);
  sampler.output = Accessor::from_floats({0, 0, 0, 1, 0, -std::sqrt(0.5f), 0, std::sqrt(0.5f)}, 4);
  Animation bend;
  bend.name = "bend";
  bend.samplers = {sampler};
  bend.channels = {{0, 2, "rotation", {}}};
  model.animations = {bend};
  return model;
}

namespace {

template <class Id>
std::vector<Id> shuffled_ids(std::size_t count, Random& random) {
  std::vector<Id> ids;
  for (std::size_t i = 0; i < count; ++i) ids.push_back(Id{i});
  for (std::size_t i = count; i > 1; --i)
    std::swap(ids[i - 1], ids[random.below(static_cast<std::uint32_t>(i))]);
  return ids;
}

}  // namespace

TriMesh shuffled(const TriMesh& mesh) {
  Random random(11);
  TriMesh result = mesh;
  const auto vertices = shuffled_ids<VertexId>(mesh.vertex_count(), random);  // old -> new
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    result.positions[vertices[v].index()] = mesh.positions[v];
    for (std::size_t t = 0; t < mesh.target_count(); ++t)
      result.position_morphs[t][vertices[v].index()] = mesh.position_morphs[t][v];
  }
  const auto faces = shuffled_ids<FaceId>(mesh.face_count(), random);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      result.triangles[faces[f].index()][k] = vertices[mesh.triangles[f][k].index()];
    result.face_part[faces[f].index()] = mesh.face_part[f];
  }
  for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
    const AttributeLayer& from = mesh.layers[l];
    AttributeLayer& to = result.layers[l];
    const auto values = shuffled_ids<ValueId>(from.size(), random);
    for (std::size_t v = 0; v < values.size(); ++v) {
      for (int k = 0; k < from.width; ++k) to.value(values[v])[k] = from.value(ValueId{v})[k];
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const ValueId value = from.corner_value[corner(FaceId{f}, k).index()];
        to.corner_value[corner(faces[f], k).index()] = value.valid() ? values[value.index()] : value;
      }
    }
  }
  result.source_vertex.clear();
  check(result);
  return result;
}

TriMesh scaled(TriMesh mesh, float scale) {
  for (Vec3f& p : mesh.positions) p = p * scale;
  return mesh;
}

}  // namespace fovea::test
