#include "fovea/io/field_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "fovea/base/random.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::bytes_of;
using test::expect_error;
using test::TempFolder;

std::string npy(const std::string& type, const std::string& shape, const std::string& data,
                char version = 1) {
  const std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  std::string file = "\x93NUMPY";
  file += version;
  file += '\0';
  file += static_cast<char>(header.size());
  file += std::string(version == 1 ? 1 : 3, '\0');
  return file + header + data;
}

template <class T>
std::string raw(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::vector<float> parse(const std::string& file) { return parse_npy(bytes_of(file), "a.npy"); }

TEST(FieldFile, TypesOfNpy) {
  const std::vector<float> expected = {0, 1, 2.5f};
  EXPECT_EQ(parse(npy("<f4", "(3,)", raw<float>({0, 1, 2.5f}))), expected);
  EXPECT_EQ(parse(npy("<f8", "(3, 1)", raw<double>({0, 1, 2.5}))), expected);
  EXPECT_EQ(parse(npy("<f8", "(1, 3)", raw<double>({0, 1, 2.5}), 2)), expected);
  EXPECT_EQ(parse(npy("|i1", "(2,)", raw<std::int8_t>({-1, 5}), 3)), (std::vector<float>{-1, 5}));
  EXPECT_EQ(parse(npy("|u1", "(2,)", raw<std::uint8_t>({255, 5}))), (std::vector<float>{255, 5}));
  EXPECT_EQ(parse(npy("|b1", "(2,)", raw<std::uint8_t>({1, 0}))), (std::vector<float>{1, 0}));
  EXPECT_EQ(parse(npy("<i2", "(1,)", raw<std::int16_t>({-300}))), (std::vector<float>{-300}));
  EXPECT_EQ(parse(npy("<u2", "(1,)", raw<std::uint16_t>({60000}))), (std::vector<float>{60000}));
  EXPECT_EQ(parse(npy("<i4", "(1,)", raw<std::int32_t>({-70000}))), (std::vector<float>{-70000}));
  EXPECT_EQ(parse(npy("<u4", "(1,)", raw<std::uint32_t>({3000000000u}))), (std::vector<float>{3e9f}));
  EXPECT_EQ(parse(npy("<i8", "()", raw<std::int64_t>({-9}))), (std::vector<float>{-9}));
  EXPECT_EQ(parse(npy("<u8", "(0,)", "")), std::vector<float>{});
}

TEST(FieldFile, DamagedNpyIsRefused) {
  const auto refused = [](const std::string& file, ErrorKind kind) {
    expect_error([&] { parse(file); }, kind, "a.npy");
  };
  refused("", ErrorKind::format);
  refused("\x93NUMPY", ErrorKind::unsupported);
  refused(std::string("\x93NUMPY\x01\0\xFF\xFF{}", 12), ErrorKind::format);
  refused(npy("<f4", "(3,)", raw<float>({1, 2})), ErrorKind::format);
  refused(npy("<f8", "(18446744073709551615,)", "12345678"), ErrorKind::format);
  refused(npy("<f8", "(99999999999999999999,)", "12345678"), ErrorKind::format);
  refused(npy("<f4", "(2, 2)", raw<float>({1, 2, 3, 4})), ErrorKind::unsupported);
  refused(npy(">f4", "(1,)", "1234"), ErrorKind::unsupported);
  refused(npy("<c8", "(1,)", "12345678"), ErrorKind::unsupported);
  refused(npy("<U7", "(1,)", "12345678"), ErrorKind::unsupported);
  refused(npy("<f4", "(-1,)", "1234"), ErrorKind::format);
  refused(npy("<f4", "7", "1234"), ErrorKind::format);
}

TEST(FieldFile, WrittenNpyReadsBackAndIsAligned) {
  TempFolder folder;
  for (const std::size_t count : {0u, 1u, 3u, 100000u}) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = std::sqrt(static_cast<float>(i)) - 1;
    const auto bytes = encode_npy(values);
    // The format asks for data that begins at a multiple of 64.
    EXPECT_EQ((bytes.size() - 4 * count) % 64, 0u);
    write_npy(folder.path() / "a.npy", values, true);
    EXPECT_EQ(read_npy(folder.path() / "a.npy"), values);
    EXPECT_EQ(read_field(folder.path() / "a.npy"), values);
  }
  expect_error([&] { write_npy(folder.path() / "a.npy", {}, false); }, ErrorKind::usage, "a.npy");
}

TEST(FieldFile, Text) {
  TempFolder folder;
  const auto read = [&](const std::string& text) { return read_field(folder.add("a.csv", text)); };
  EXPECT_EQ(read("1\n2.5\n\n# remark\n-3e1"), (std::vector<float>{1, 2.5f, -30}));
  EXPECT_EQ(read("vertex,weight\r\n0, 0.5\r\n1, 0.25,\r\n"), (std::vector<float>{0.5f, 0.25f}));
  expect_error([&] { read("1\n2\nthree\n"); }, ErrorKind::format, "a.csv: line 3");
  expect_error([&] { read("1\n2x\n"); }, ErrorKind::format, "a.csv: line 2");
}

/// Two triangles of three source vertices each with one edge in common, and a vertex that nothing uses.
Model two_triangles() {
  SplitPart part;
  part.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {9, 9, 9}};
  part.indices = {0, 1, 2, 3, 4, 5};
  VertexArray importance;
  importance.semantic = Semantic::custom;
  importance.name = "_IMPORTANCE";
  importance.width = 1;
  importance.values = {1, 2, 3, 4, 5, 3, 0};
  VertexArray color;
  color.semantic = Semantic::color;
  color.width = 4;
  for (int v = 0; v < 7; ++v) color.values.insert(color.values.end(), {0, 0.5f, 1, 0.1f});
  part.attributes = {importance, color};
  Model model;
  model.meshes.push_back({"a", test::weld_part(part), {}, {}});
  model.meshes.push_back({"b", test::tetrahedron(), {}, {}});
  return model;
}

float at(const Model& model, const std::vector<VertexField>& fields, Vec3f position) {
  const auto& positions = model.meshes[0].surface.positions;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (positions[v] == position) return fields[0][VertexId{v}];
  }
  return std::numeric_limits<float>::quiet_NaN();
}

TEST(FieldFile, SourceOrderKeepsTheLargestOfWeldedVertices) {
  const Model model = two_triangles();
  const std::size_t sources = 7 + model.meshes[1].surface.source_vertex.size();
  std::vector<float> values(sources, 10);
  const std::vector<float> first = {1, 2, 3, 7, 5, 2, 99};
  std::copy(first.begin(), first.end(), values.begin());
  const auto fields = field_from_source_order(model, values);
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(at(model, fields, {0, 0, 0}), 1);
  EXPECT_EQ(at(model, fields, {1, 0, 0}), 7);
  EXPECT_EQ(at(model, fields, {0, 1, 0}), 3);
  EXPECT_EQ(at(model, fields, {1, 1, 0}), 5);
  for (const float x : fields[1].values()) EXPECT_EQ(x, 10);
}

TEST(FieldFile, OneValuePerWeldedVertexIsTakenInTheirOrder) {
  const Model model = two_triangles();
  const std::size_t first = model.meshes[0].surface.vertex_count(),
                    second = model.meshes[1].surface.vertex_count();
  std::vector<float> values;
  for (std::size_t v = 0; v < first + second; ++v) values.push_back(static_cast<float>(v));
  const auto fields = field_from_source_order(model, values);
  EXPECT_EQ(fields[0][VertexId{std::size_t{2}}], 2);
  EXPECT_EQ(fields[1][VertexId{std::size_t{0}}], static_cast<float>(first));
}

TEST(FieldFile, WrongSizesAndNumbersAreFormatErrors) {
  const Model model = two_triangles();
  expect_error([&] { field_from_source_order(model, std::vector<float>(3)); }, ErrorKind::format, "",
               "3 values");
  std::vector<float> values(8, 1);  // 4 + 4 welded vertices
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), -infinity}) {
    values[5] = wrong;
    expect_error([&] { field_from_source_order(model, values); }, ErrorKind::format, "", "value 5");
  }
  values[5] = infinity;  // locks a vertex
  EXPECT_NO_THROW(field_from_source_order(model, values));
}

TEST(FieldFile, AttributesAreAveragedOverTheValuesOfAVertex) {
  const Model model = two_triangles();
  for (const char* name : {"_IMPORTANCE", "IMPORTANCE"}) {
    const auto fields = field_from_attribute(model, name);
    EXPECT_EQ(at(model, fields, {0, 0, 0}), 1);
    EXPECT_EQ(at(model, fields, {1, 0, 0}), 3);  // of 2 and 4
    EXPECT_EQ(at(model, fields, {0, 1, 0}), 3);  // 3 on both sides
    for (const float x : fields[1].values()) EXPECT_EQ(x, 1);
  }
  const auto colors = field_from_attribute(model, "COLOR_0");
  EXPECT_EQ(at(model, colors, {1, 1, 0}), 0.5f);  // mean of 0, 0.5 and 1
}

TEST(FieldFile, UnknownAttributesNameThosePresent) {
  const auto error = test::error_of([] { field_from_attribute(two_triangles(), "_HEAT"); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::unsupported);
  EXPECT_NE(error->hint().find("COLOR_0, _IMPORTANCE"), std::string::npos) << error->hint();
}

// --- Writing ---------------------------------------------------------------------------------------

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
  std::vector<std::uint32_t> bits;
  for (const float x : values) bits.push_back(std::bit_cast<std::uint32_t>(x));
  return bits;
}

TEST(FieldFile, WrittenFieldsReadBackTheSameBits) {
  using Limits = std::numeric_limits<float>;
  std::vector<float> values = {0.0f,
                               -0.0f,
                               1,
                               1.0f / 3,
                               -1e-7f,
                               16777216,
                               1e21f,
                               Limits::max(),
                               Limits::lowest(),
                               Limits::min(),
                               Limits::denorm_min(),
                               -Limits::denorm_min(),
                               std::nextafter(1.0f, 2.0f),
                               Limits::infinity(),
                               -Limits::infinity()};
  Random random(1);
  while (values.size() < 2000) {
    const float x = std::bit_cast<float>(random.below(0xFFFFFFFFu));
    if (!std::isnan(x)) values.push_back(x);  // of what is not a number text keeps no bits
  }
  const TempFolder folder;
  for (const char* name : {"a.npy", "a.csv", "a.txt", "b.NPY", "b.Csv"}) {
    write_field(folder.path() / name, values, "saliency", false);
    EXPECT_EQ(bits_of(read_field(folder.path() / name)), bits_of(values)) << name;
  }
  write_field(folder.path() / "c.csv", std::vector<float>{0.1f, 2}, "saliency", false);
  const auto bytes = read_file(folder.path() / "c.csv", 100);
  EXPECT_EQ(test::text_of(bytes), "saliency\n0.1\n2\n") << "the shortest digits, below a heading";
}

TEST(FieldFile, AnEmptyFieldIsAFileToo) {
  const TempFolder folder;
  for (const char* name : {"a.npy", "a.csv"}) {
    write_field(folder.path() / name, {}, "saliency", false);
    EXPECT_TRUE(read_field(folder.path() / name).empty()) << name;
  }
}

TEST(FieldFile, WhatCannotBeWrittenIsRefusedBeforehandAndWhenWriting) {
  const TempFolder folder;
  const auto refused = [&](const std::string& name, bool force, ErrorKind kind, const std::string& message) {
    const auto path = folder.path() / name;
    expect_error([&] { check_field_output(path, force); }, kind, name, message);
    expect_error([&] { write_field(path, std::vector<float>{1}, "x", force); }, kind, name, message);
  };
  for (const char* name : {"a.glb", "a.png", "a", "npy", ".npy", "a.npy.bak"}) {
    refused(name, true, ErrorKind::usage,
            std::filesystem::path(name).extension().empty() ? "no extension" : "not written as");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / name));
  }
  folder.add("old.csv", "precious");
  refused("old.csv", false, ErrorKind::usage, "exists");
  EXPECT_EQ(test::text_of(read_file(folder.path() / "old.csv", 100)), "precious");
  EXPECT_NO_THROW(check_field_output(folder.path() / "old.csv", true));
  write_field(folder.path() / "old.csv", std::vector<float>{5}, "x", true);
  EXPECT_EQ(read_field(folder.path() / "old.csv"), std::vector<float>{5});
  const auto error = test::error_of([&] { check_field_output(folder.path() / "no/a.npy", true); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::output);
}

/// A number of its own for every vertex.
std::vector<VertexField> numbered(const Model& model) {
  std::vector<VertexField> fields;
  float next = 0.125f;
  for (const Mesh& mesh : model.meshes) {
    VertexField& field = fields.emplace_back(mesh.surface.vertex_count());
    for (float& x : field.values()) x = next += 1;
  }
  return fields;
}

void expect_way_back(const Model& model, const std::string& name) {
  const auto fields = numbered(model);
  const std::vector<float> values = field_in_source_order(model, fields);
  std::size_t sources = 0;
  for (const Mesh& mesh : model.meshes) {
    const TriMesh& surface = mesh.surface;
    sources += surface.source_vertex.empty() ? surface.vertex_count() : surface.source_vertex.size();
  }
  EXPECT_EQ(values.size(), sources) << name;
  EXPECT_EQ(field_from_source_order(model, values), fields) << name;
}

TEST(FieldFile, SourceOrderThereAndBack) {
  const Model model = two_triangles();
  const std::vector<float> values = field_in_source_order(model, numbered(model));
  // Both vertices of a seam get the number of their point, and what no triangle uses gets 0.
  EXPECT_EQ(values[1], values[3]);
  EXPECT_EQ(values[2], values[5]);
  EXPECT_EQ(values[6], 0);
  EXPECT_NE(values[0], values[4]);
  expect_way_back(model, "two triangles");
  for (const auto& [name, mesh] : test::all_families()) expect_way_back(test::model_of({mesh, mesh}), name);
  Model without_source = test::model_of({test::cube(), test::torus(12, 8)});
  without_source.meshes[0].surface.source_vertex.clear();
  expect_way_back(without_source, "a mesh that came from no file");
  expect_way_back(Model{}, "nothing");
}

TEST(FieldFile, SourceOrderIsThatOfTheFile) {
  const TempFolder folder;
  Context context;
  // The third vertex is not used, the last is at the place of the first.
  const auto obj = folder.add("a.obj",
                              "v 1 0 0\nv 2 0 0\nv 9 9 9\nv 2 1 0\nv 1 0 0\nv 0 1 0\n"
                              "f 1 2 4\nf 5 4 6\n");
  const auto ply = folder.add("a.ply",
                              "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                              "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                              "end_header\n1 0 0\n2 0 0\n9 9 9\n2 1 0\n1 0 0\n0 1 0\n3 0 1 3\n3 4 3 5\n");
  for (const auto& path : {obj, ply}) {
    const Model model = read_model(path, {}, context);
    ASSERT_EQ(model.meshes.size(), 1u);
    VertexField x_plus_10y(model.meshes[0].surface.vertex_count());
    for (std::size_t v = 0; v < x_plus_10y.size(); ++v) {
      const Vec3f p = model.meshes[0].surface.positions[v];
      x_plus_10y.values()[v] = p.x + 10 * p.y;
    }
    EXPECT_EQ(field_in_source_order(model, {&x_plus_10y, 1}), (std::vector<float>{1, 2, 0, 12, 1, 10}))
        << path;
    expect_way_back(model, path.string());
  }
  // What Fovea wrote and reads: several meshes, seams, and parts that share points.
  for (const char* name : {"a.glb", "b.gltf"}) {
    Model model = test::model_of({test::cube(), test::two_part_grid(4, 3), test::open_cylinder(8, 3)});
    model.materials.resize(2);
    write_model(model, folder.path() / name, {}, context);
    expect_way_back(read_model(folder.path() / name, {}, context), name);
  }
}

TEST(FieldFile, FieldsOfAnotherModelAreRefused) {
  const Model model = two_triangles();
  auto fields = numbered(model);
  fields[1] = VertexField(2);
  expect_error([&] { field_in_source_order(model, fields); }, ErrorKind::usage, "", "mesh 1");
  expect_error([&] { field_in_source_order(model, {}); }, ErrorKind::usage, "", "2 meshes");
}

}  // namespace
}  // namespace fovea
