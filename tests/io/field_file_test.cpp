#include "fovea/io/field_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

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

TEST(FieldFile, WrongSizesAndNumbersAreUsageErrors) {
  const Model model = two_triangles();
  expect_error([&] { field_from_source_order(model, std::vector<float>(3)); }, ErrorKind::usage, "",
               "3 values");
  std::vector<float> values(8, 1);  // 4 + 4 welded vertices
  values[5] = std::numeric_limits<float>::infinity();
  expect_error([&] { field_from_source_order(model, values); }, ErrorKind::usage, "", "value 5");
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
  EXPECT_EQ(error->kind(), ErrorKind::usage);
  EXPECT_NE(error->hint().find("COLOR_0, _IMPORTANCE"), std::string::npos) << error->hint();
}

}  // namespace
}  // namespace fovea
