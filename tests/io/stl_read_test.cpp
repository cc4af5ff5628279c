#include "fovea/io/stl_read.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "support/reading.h"

namespace fovea {
namespace {

using test::bytes_of;
using test::expect_error;

constexpr const char* kText =
    "solid two\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  "
    "endloop\n"
    " endfacet\n facet normal 0 0 1\r\n outer loop\n VERTEX 1 0 0\n vertex 1e0 1 0\n vertex 0 1 0\n "
    "endloop\n endfacet\n"
    "endsolid\n";

void put(std::string& to, float value) {
  char raw[4];
  std::memcpy(raw, &value, 4);
  to.append(raw, 4);
}

std::string binary(std::uint32_t told, const std::vector<std::array<float, 9>>& triangles,
                   const char* head = "solid") {
  std::string file = head;
  file.resize(80, ' ');
  for (int i = 0; i < 4; ++i) file += static_cast<char>(told >> (8 * i) & 0xFF);
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) put(file, 0);
    for (const float x : t) put(file, x);
    file += std::string(2, '\0');
  }
  return file;
}

Model read(const std::string& file) {
  Context context;
  Model model = read_stl(bytes_of(file), "test.stl", {}, context);
  check(model.meshes.at(0).surface);
  return model;
}

void expect_stl_refused(const std::string& file, ErrorKind kind, const std::string& place) {
  Context context;
  expect_error([&] { read_stl(bytes_of(file), "test.stl", {}, context); }, kind, place);
}

TEST(StlRead, TextAndBinaryWeldEqually) {
  const std::string file = binary(2, {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, 0}});
  EXPECT_TRUE(is_stl(bytes_of(kText)));
  EXPECT_TRUE(is_stl(bytes_of(file)));
  for (const Model& model : {read(kText), read(file)}) {
    const TriMesh& mesh = model.meshes[0].surface;
    EXPECT_EQ(mesh.face_count(), 2u);
    EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
    EXPECT_EQ(mesh.source_vertex.size(), 6u);
    EXPECT_TRUE(mesh.layers.empty());
  }
}

TEST(StlRead, DamagedFilesAreRefusedWithThePlace) {
  expect_stl_refused(binary(3, {{0, 0, 0, 1, 0, 0, 0, 1, 0}}, "x"), ErrorKind::format, "test.stl: byte 80");
  expect_stl_refused(binary(0xFFFFFFFF, {}, "x"), ErrorKind::format, "test.stl: byte 80");
  expect_stl_refused("x", ErrorKind::format, "test.stl");
  expect_stl_refused(binary(0, {}), ErrorKind::unsupported, "test.stl");
  expect_stl_refused(binary(1, {{0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 1, 0}}),
                     ErrorKind::format, "test.stl: byte 108");
  expect_stl_refused("solid\nfacet normal 0 0 1\nvertex 0 0\n", ErrorKind::format, "test.stl: line 3");
  expect_stl_refused("solid\nfacet normal 0 0 1\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n", ErrorKind::format,
                     "test.stl: line 5");
  expect_stl_refused("solid\nfacet normal 0 0 1\nvertex 0 0 0\n", ErrorKind::format, "test.stl: line 4");
}

}  // namespace
}  // namespace fovea
