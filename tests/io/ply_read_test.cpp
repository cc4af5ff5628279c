#include "fovea/io/ply_read.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "support/reading.h"

namespace fovea {
namespace {

using test::bytes_of;
using test::expect_error;
using test::told;

struct ReadPly {
  Context context;
  Model model;
  explicit ReadPly(const std::string& text, const std::filesystem::path& folder = "/nonexistent") {
    model = read_ply(bytes_of(text), folder, "test.ply", {}, context);
    check(model.meshes.at(0).surface);
  }
  const TriMesh& mesh() const { return model.meshes.at(0).surface; }
};

void expect_ply_refused(const std::string& text, ErrorKind kind, const std::string& place,
                        const std::string& message = {}) {
  Context context;
  expect_error([&] { read_ply(bytes_of(text), {}, "test.ply", {}, context); }, kind, place, message);
}

std::string ascii(const std::string& properties, int vertices, const std::string& rows, int faces = 1,
                  const std::string& face_rows = "3 0 1 2\n") {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) + "\n" + properties +
         "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n" +
         rows + face_rows;
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kTriangleRows = "0 0 0\n1 0 0\n0 1 0\n";

template <class T>
void put(std::string& to, T value, bool big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  to.append(raw, sizeof(T));
}

TEST(PlyRead, AsciiTriangle) {
  const ReadPly read(ascii(kXyz, 3, kTriangleRows));
  EXPECT_EQ(read.mesh().positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(read.mesh().face_count(), 1u);
  EXPECT_EQ(read.model.meshes[0].name, "test");
  EXPECT_TRUE(read.context.diagnostics().empty());
}

TEST(PlyRead, BothByteOrdersAndAllTypes) {
  for (const bool big : {false, true}) {
    std::string file =
        std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\r\nelement extra 1\r\nproperty list ushort double junk\r\nelement vertex 3\r\n"
        "property double x\r\nproperty float y\r\nproperty short z\r\nproperty uchar red\r\n"
        "property uchar green\r\nproperty uchar blue\r\nproperty int id\r\nproperty ushort u16\r\n"
        "property char i8\r\nproperty uint u32\r\n"
        "element face 1\r\nproperty uchar flags\r\nproperty list int ushort vertex_index\r\nend_header\r\n";
    put<std::uint16_t>(file, 2, big);
    put<double>(file, 1, big);
    put<double>(file, 2, big);
    for (int v = 0; v < 3; ++v) {
      put<double>(file, v == 1, big);
      put<float>(file, v == 2, big);
      put<std::int16_t>(file, -7, big);
      for (const int c : {255, 0, 255}) put<std::uint8_t>(file, static_cast<std::uint8_t>(c), big);
      put<std::int32_t>(file, -100000 * v, big);
      put<std::uint16_t>(file, 60000, big);
      put<std::int8_t>(file, -5, big);
      put<std::uint32_t>(file, 3000000000u, big);
    }
    put<std::uint8_t>(file, 9, big);
    put<std::int32_t>(file, 3, big);
    for (const int i : {0, 1, 2}) put<std::uint16_t>(file, static_cast<std::uint16_t>(i), big);
    const ReadPly read(file);
    EXPECT_EQ(read.mesh().positions, (std::vector<Vec3f>{{0, 0, -7}, {1, 0, -7}, {0, 1, -7}})) << big;
    ASSERT_TRUE(read.mesh().find(Semantic::color));
    EXPECT_EQ(read.mesh().find(Semantic::color)->values, (std::vector<float>{1, 0, 1, 1, 0, 1, 1, 0, 1}));
    ASSERT_EQ(read.mesh().layers.size(), 5u);
    EXPECT_EQ(read.mesh().layers[1].name, "_id");
    EXPECT_EQ(read.mesh().layers[1].values, (std::vector<float>{0, -100000, -200000}));
    EXPECT_EQ(read.mesh().layers[2].values[0], 60000);
    EXPECT_EQ(read.mesh().layers[3].values[0], -5);
    EXPECT_EQ(read.mesh().layers[4].values[0], 3e9f);
  }
}

TEST(PlyRead, AttributesOfVertices) {
  const ReadPly read(ascii(kXyz +
                               "property float nx\nproperty float ny\nproperty float nz\nproperty float s\n"
                               "property float t\nproperty float quality\nproperty float _done\n",
                           3, "0 0 0 0 0 2 0 0 .5 1\n1 0 0 0 0 2 1 0.25 .25 2\n0 1 0 0 0 2 0 1 7 3\n"));
  ASSERT_EQ(read.mesh().layers.size(), 4u);
  EXPECT_EQ(read.mesh().find(Semantic::normal)->values, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(read.mesh().find(Semantic::uv)->values, (std::vector<float>{0, 1, 1, 0.75f, 0, 0}));
  EXPECT_EQ(read.mesh().layers[2].name, "_quality");
  EXPECT_EQ(read.mesh().layers[2].values, (std::vector<float>{.5f, .25f, 7}));
  EXPECT_EQ(read.mesh().layers[3].name, "_done");
}

TEST(PlyRead, SourceVerticesAreTheRows) {
  const ReadPly read(ascii(kXyz, 5, "0 0 0\n9 9 9\n1 0 0\n0 1 0\n0 0 0\n", 2, "3 0 2 3\n3 2 4 3\n"));
  const auto& source = read.mesh().source_vertex;
  ASSERT_EQ(source.size(), 5u);
  EXPECT_FALSE(source[1].valid());
  EXPECT_EQ(source[0], source[4]);
}

TEST(PlyRead, WedgeTextureCoordinatesAndSeveralTextures) {
  test::TempFolder folder;
  folder.add("a.png", test::tiny_png());
  folder.add("b.png", test::tiny_png() + " ");
  const std::string file =
      "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\nelement vertex 4\n" +
      kXyz +
      "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property int texnumber\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
      "3 0 1 2 6 0 0 1 0 0 1 1\n3 1 3 2 6 0.5 0.5 1 1 0.5 0 0\n";
  const ReadPly read(file, folder.path());
  ASSERT_EQ(read.mesh().parts.size(), 2u);
  EXPECT_EQ(read.mesh().parts[0].material, 1);
  EXPECT_EQ(read.mesh().parts[1].material, 0);
  ASSERT_EQ(read.model.images.size(), 2u);
  EXPECT_EQ(read.model.images[1].uri, "b.png");
  EXPECT_EQ(read.mesh().vertex_count(), 4u);
  const AttributeLayer* uv = read.mesh().find(Semantic::uv);
  EXPECT_EQ(uv->size(), 6u);
  EXPECT_EQ(uv->value(uv->corner_value[2])[1], 0.0f);
  EXPECT_EQ(read.mesh().source_vertex.size(), 4u);
}

TEST(PlyRead, PolygonsAndStrips) {
  const ReadPly quad(ascii(kXyz, 4, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", 1, "4 0 1 2 3\n"));
  EXPECT_EQ(quad.mesh().face_count(), 2u);
  const ReadPly strip("ply\nformat ascii 1.0\nelement vertex 5\n" + kXyz +
                      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 0 1 2\n");
  ASSERT_EQ(strip.mesh().face_count(), 4u);
  for (const auto& t : strip.mesh().triangles) {
    const auto p = [&](std::size_t k) { return Vec3d(strip.mesh().positions[t[k].index()]); };
    EXPECT_GT(cross(p(1) - p(0), p(2) - p(0)).z, 0);  // every triangle of a strip faces the same way
  }
}

TEST(PlyRead, SmallFacesAreDroppedAndBadNormalsMadeAnew) {
  const ReadPly read(ascii(kXyz + "property float nx\nproperty float ny\nproperty float nz\n", 3,
                           "0 0 0 0 0 0\n1 0 0 0 0 1\n0 1 0 nan 0 0\n", 2, "2 0 1\n3 0 1 2\n"));
  EXPECT_EQ(told(read.context, "small-faces"), 1u);
  EXPECT_EQ(told(read.context, "bad-normals"), 2u);
  EXPECT_EQ(read.mesh().find(Semantic::normal)->values, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
}

TEST(PlyRead, ForgottenWordCommentIsForgiven) {
  std::string file = ascii(kXyz, 3, kTriangleRows);
  file.insert(file.find("element"), "Created by some program\nobj_info made in 1994\n");
  EXPECT_EQ(ReadPly(file).mesh().face_count(), 1u);
}

TEST(PlyRead, PointCloudsAreUnsupported) {
  expect_ply_refused(ascii(kXyz, 3, kTriangleRows, 0, ""), ErrorKind::unsupported, "test.ply",
                     "no triangles");
}

TEST(PlyRead, DamagedFilesAreRefusedWithThePlace) {
  expect_ply_refused("ply\nformat ascii 1.0\n", ErrorKind::format, "test.ply: line 3", "no end");
  expect_ply_refused("ply\nend_header\n", ErrorKind::format, "test.ply", "no format");
  expect_ply_refused("ply\nformat morse 1.0\nend_header\n", ErrorKind::format, "test.ply: line 2");
  expect_ply_refused("ply\nformat ascii 1.0\nelement vertex\nend_header\n", ErrorKind::format,
                     "test.ply: line 3");
  expect_ply_refused("ply\nformat ascii 1.0\nproperty float x\nend_header\n", ErrorKind::format,
                     "test.ply: line 3");
  expect_ply_refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n",
                     ErrorKind::format, "test.ply: line 4");
  expect_ply_refused(ascii("property float x\nproperty float y\n", 3, "0 0\n0 0\n0 0\n"), ErrorKind::format,
                     "test.ply", "x, y, z");
  expect_ply_refused(ascii(kXyz, 3, kTriangleRows, 1, "3 0 1 3\n"), ErrorKind::format, "test.ply: line 13",
                     "index 3");
  expect_ply_refused(ascii(kXyz, 3, kTriangleRows, 1, "3 0 1 -1\n"), ErrorKind::format, "test.ply: line 13");
  expect_ply_refused(ascii(kXyz, 3, kTriangleRows, 1, "3 0 1"), ErrorKind::format, "test.ply",
                     "longer than the file");
  expect_ply_refused(ascii(kXyz, 3, "0 0 0\n1 0 here\n0 1 0\n"), ErrorKind::format, "test.ply: line 11",
                     "not a number");
  expect_ply_refused(ascii(kXyz, 3, "0 0 0\n1 0 inf\n0 1 0\n"), ErrorKind::format, "test.ply", "finite");
}

TEST(PlyRead, CountsBeyondTheFileAreRefusedBeforeMemoryIsTaken) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string rest = "\n" + kXyz + "end_header\nabc";
  for (const char* count : {"2", "1000000000000", "4294967296", "18446744073709551615"}) {
    expect_ply_refused(head + count + rest, ErrorKind::format, "test.ply: header", "bytes follow");
  }
  expect_ply_refused(head + "99999999999999999999999" + rest, ErrorKind::format, "test.ply: line 3");
  // A list of 4294967295 numbers in a file of some bytes.
  expect_ply_refused("ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + kXyz +
                         "element face 1\nproperty list uint double vertex_indices\nend_header\n" +
                         std::string(12, '\0') + "\xFF\xFF\xFF\xFF",
                     ErrorKind::format, "test.ply: byte", "longer than the file");
  // An element without properties takes no bytes: any count is harmless, and must not be counted out.
  std::string empty = ascii(kXyz, 3, kTriangleRows);
  empty.insert(empty.find("element face"), "element nothing 18446744073709551615\n");
  Context context;
  ReadOptions options;
  expect_error([&] { read_ply(bytes_of(empty), {}, "test.ply", options, context); }, ErrorKind::limit,
               "test.ply");
}

TEST(PlyRead, BigEndianQuads) {
  const auto path = test::corpus_file("conformance/generated/quad-grid-big-endian.ply");
  if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
  Context context;
  const Model model = read_model(*path, {}, context);
  EXPECT_EQ(counts(model).triangles, 8u);  // four quads
  EXPECT_EQ(counts(model).vertices, 9u);
  EXPECT_TRUE(model.meshes[0].surface.find(Semantic::color));
}

TEST(PlyRead, Scans) {
  struct Case {
    const char* name;
    std::uint64_t triangles, rows;
  };
  for (const Case& c :
       {Case{"armadillo", 86482, 43243}, Case{"bunny", 69451, 35947}, Case{"hand", 15982, 7993}}) {
    const auto path = test::corpus_file(std::string("scans/") + c.name + ".ply");
    if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
    Context context;
    const Model model = read_model(*path, {}, context);
    EXPECT_EQ(counts(model).triangles, c.triangles) << c.name;
    EXPECT_EQ(model.meshes[0].surface.source_vertex.size(), c.rows) << c.name;
  }
}

}  // namespace
}  // namespace fovea
