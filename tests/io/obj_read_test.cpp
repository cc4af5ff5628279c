#include "fovea/io/obj_read.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/reading.h"

namespace fovea {
namespace {

using test::bytes_of;
using test::expect_error;
using test::TempFolder;
using test::told;

struct ReadObj {
  Context context;
  Model model;
  explicit ReadObj(const std::string& text, const std::filesystem::path& folder = "/nonexistent",
                   const ReadOptions& options = {}) {
    model = read_obj(bytes_of(text), folder, "test.obj", options, context);
    check(model.meshes.at(0).surface);
  }
  const TriMesh& mesh() const { return model.meshes.at(0).surface; }
};

void expect_obj_refused(const std::string& text, const std::string& place, const std::string& message = {}) {
  Context context;
  expect_error([&] { read_obj(bytes_of(text), {}, "test.obj", {}, context); }, ErrorKind::format, place,
               message);
}

constexpr const char* kObjTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ObjRead, OneTriangle) {
  const ReadObj read(std::string(kObjTriangle) + "f 1 2 3\n");
  EXPECT_EQ(read.mesh().face_count(), 1u);
  EXPECT_EQ(read.mesh().positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(read.mesh().layers.empty());
  EXPECT_EQ(read.model.meshes[0].name, "test");
  ASSERT_EQ(read.model.nodes.size(), 1u);
  EXPECT_EQ(read.model.nodes[0].mesh, 0);
  EXPECT_TRUE(read.context.diagnostics().empty());
}

TEST(ObjRead, TextureCoordinatesCountFromTheTopLeft) {
  const ReadObj read(std::string(kObjTriangle) + "vt 0.25 0.75\nvt 1\nvt 0 1 0\nf 1/1 2/2 3/3\n");
  const AttributeLayer* uv = read.mesh().find(Semantic::uv);
  ASSERT_TRUE(uv);
  EXPECT_EQ(uv->values, (std::vector<float>{0.25f, 0.25f, 1, 1, 0, 0}));
}

TEST(ObjRead, SeamsBelongToTheirLayerOnly) {
  // Two triangles on the edge 2-3: the texture is cut there, the normals are not.
  const ReadObj read(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt .5 .5\nvn 0 0 1\n"
      "f 1/1/1 2/2/1 3/3/1\nf 2/4/1 4/1/1 3/4/1\n");
  EXPECT_EQ(read.mesh().vertex_count(), 4u);
  EXPECT_EQ(read.mesh().find(Semantic::uv)->size(), 6u);
  EXPECT_EQ(read.mesh().find(Semantic::normal)->size(), 4u);
}

TEST(ObjRead, NormalsGetLengthOneAndBadOnesAreMadeAnew) {
  const ReadObj read(std::string(kObjTriangle) + "vn 0 0 5\nvn 0 0 0\nf 1//1 2//1 3//2\n");
  const AttributeLayer* normals = read.mesh().find(Semantic::normal);
  ASSERT_TRUE(normals);
  EXPECT_EQ(normals->values, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(told(read.context, "bad-normals"), 1u);
}

TEST(ObjRead, NegativeIndicesCountFromThePresentEnd) {
  const ReadObj read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -4 -2 -1\n");
  ASSERT_EQ(read.mesh().face_count(), 2u);
  const auto second = read.mesh().triangles[1];
  EXPECT_EQ(read.mesh().positions[second[0].index()], (Vec3f{0, 0, 0}));
  EXPECT_EQ(read.mesh().positions[second[1].index()], (Vec3f{0, 1, 0}));
  EXPECT_EQ(read.mesh().positions[second[2].index()], (Vec3f{0, 0, 1}));
}

TEST(ObjRead, FacesMayComeBeforeTheirVertices) {
  const ReadObj read(std::string("f 1 2 3\n") + kObjTriangle);
  EXPECT_EQ(read.mesh().face_count(), 1u);
}

TEST(ObjRead, SourceVerticesAreTheLinesOfTheFile) {
  // Line 2 and 4 are the same point, line 5 is used by nothing.
  const ReadObj read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 9 9 9\nv 1 1 0\nf 1 2 3\nf 4 6 3\n");
  const auto& source = read.mesh().source_vertex;
  ASSERT_EQ(source.size(), 6u);
  EXPECT_EQ(source[1], source[3]);
  EXPECT_FALSE(source[4].valid());
  EXPECT_EQ(read.mesh().vertex_count(), 4u);
  EXPECT_EQ(read.mesh().positions[source[5].index()], (Vec3f{1, 1, 0}));
}

TEST(ObjRead, SourceVerticesAreTheLinesOfTheFileWithSeamsAndMaterialsToo) {
  const ReadObj read(
      "v 0 0 0\nv 9 9 9\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 1\n"
      "usemtl b\nf 1/1 3/1 4/1\nusemtl a\nf 3/2 5/2 4/2\n");
  const auto& source = read.mesh().source_vertex;
  ASSERT_EQ(source.size(), 5u);
  const std::vector<Vec3f> lines = {{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  for (std::size_t i = 0; i < 5; ++i) {
    if (i == 1) continue;
    ASSERT_TRUE(source[i].valid());
    EXPECT_EQ(read.mesh().positions[source[i].index()], lines[i]);
  }
  EXPECT_FALSE(source[1].valid());
}

TEST(ObjRead, LineEndsContinuationsCommentsAndPlusSigns) {
  const ReadObj read("# head\r\nv 0 0 0 # here\r\nv +1 0 \\\r\n 0\r\n\r\n  v 0 1.e0 0\r\nf 1 2 \\\n3");
  EXPECT_EQ(read.mesh().positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(read.mesh().face_count(), 1u);
}

TEST(ObjRead, TinyNumbersAreZero) {
  const ReadObj read(
      "v 1e-60 0 0\nv 1 0 0\nv 0 0.0000000000000000000000000000000000000000000000000001 1\nf 1 2 3\n");
  EXPECT_EQ(read.mesh().positions[0], (Vec3f{0, 0, 0}));
}

TEST(ObjRead, ConcavePolygonsAreCutWithoutFlips) {
  const ReadObj read("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n");
  ASSERT_EQ(read.mesh().face_count(), 3u);
  double area = 0;
  for (const auto& t : read.mesh().triangles) {
    const auto p = [&](std::size_t k) { return Vec3d(read.mesh().positions[t[k].index()]); };
    const double z = cross(p(1) - p(0), p(2) - p(0)).z / 2;
    EXPECT_GT(z, 0);
    area += z;
  }
  EXPECT_DOUBLE_EQ(area, 10);  // 4 × 4 less the notch of 4 × 3 / 2
}

TEST(ObjRead, ColoursOfVerticesBecomeLight) {
  const ReadObj read("v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 0 1 0\nf 1 2 3\n");
  const AttributeLayer* color = read.mesh().find(Semantic::color);
  ASSERT_TRUE(color);
  EXPECT_EQ(color->width, 3);
  EXPECT_FLOAT_EQ(color->values[0], 1);
  // sRGB 0.5 is 0.2140 of the light (IEC 61966-2-1); four digits are given there.
  EXPECT_NEAR(color->values[1], 0.2140, 5e-5);
  EXPECT_EQ(color->value(color->corner_value[2])[2], 1.0f);  // a vertex without a colour is white
}

TEST(ObjRead, MaterialsInOrderOfFirstUse) {
  TempFolder folder;
  folder.add("a.mtl", "newmtl unused\nKd 1 0 0\nnewmtl red\nKd 1 0 0\nnewmtl blue glass\nKd 0 0 1\nd 0.25\n");
  const ReadObj read(
      std::string("mtllib a.mtl\n") + kObjTriangle +
          "usemtl unused\nusemtl blue glass\nf 1 2 3\nusemtl red\nf 3 2 1\nusemtl blue glass\nf 1 2 3\n",
      folder.path());
  ASSERT_EQ(read.model.materials.size(), 2u);
  EXPECT_EQ(read.model.materials[0].name, "blue glass");
  EXPECT_EQ(read.model.materials[0].base_color_factor, (std::array<double, 4>{0, 0, 1, 0.25}));
  EXPECT_EQ(read.model.materials[0].alpha_mode, AlphaMode::blend);
  EXPECT_EQ(read.model.materials[1].name, "red");
  EXPECT_EQ(read.mesh().parts.size(), 2u);
  EXPECT_EQ(read.mesh().face_part, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_TRUE(read.context.diagnostics().empty());
}

TEST(ObjRead, FacesWithAndWithoutTextureCoordinatesAreSeparateParts) {
  const ReadObj read(std::string(kObjTriangle) + "vt 0 0\nf 1/1 2/1 3/1\nf 3 2 1\n");
  ASSERT_EQ(read.mesh().parts.size(), 2u);
  const AttributeLayer* uv = read.mesh().find(Semantic::uv);
  EXPECT_TRUE(uv->corner_value[0].valid());
  EXPECT_FALSE(uv->corner_value[3].valid());
}

TEST(ObjRead, ImagesComeInOnceAsTheyAre) {
  TempFolder folder;
  const std::string png = test::tiny_png();
  folder.add("maps/my paint.png", png);
  folder.add(
      "a.mtl",
      "newmtl a\nKd 0 0 0\nmap_Kd -s 2 3 1 -o 0.5 0.25 -clamp on maps\\my paint.png\nNs 0\n"
      "newmtl b\nmap_Kd C:\\somewhere\\else\\maps/my paint.png\n"
      "newmtl c\nmap_Kd maps/my paint.png\nmap_Bump -bm 0.5 maps/my paint.png\nPr 0.3\nPm 0.7\nKe 0 1 0\n");
  const ReadObj read(std::string("mtllib a.mtl\n") + kObjTriangle + "vt 0 0\n" +
                         "usemtl a\nf 1/1 2/1 3/1\nusemtl c\nf 1/1 2/1 3/1\n",
                     folder.path());
  ASSERT_EQ(read.model.images.size(), 1u);
  EXPECT_EQ(read.model.images[0].uri, "maps/my paint.png");
  EXPECT_EQ(read.model.images[0].mime_type, "image/png");
  EXPECT_EQ(std::string(read.model.images[0].bytes.begin(), read.model.images[0].bytes.end()), png);
  ASSERT_EQ(read.model.textures.size(), 2u);  // clamped and repeated
  const Material& a = read.model.materials[0];
  ASSERT_TRUE(a.base_color);
  EXPECT_EQ(a.base_color_factor, (std::array<double, 4>{1, 1, 1, 1}));  // black would hide the image
  // From below: u' = 0.5 + 2 u, v' = 0.25 + 3 v. From above, t = 1 - v: t' = 1 - 0.25 - 3 + 3 t.
  EXPECT_EQ(a.base_color->transform, (TextureTransform{{0.5, -2.25}, 0, {2, 3}}));
  EXPECT_EQ(read.model.samplers[static_cast<std::size_t>(read.model.textures[0].sampler)].wrap_u,
            Wrap::clamp);
  EXPECT_DOUBLE_EQ(a.roughness_factor, 1);
  const Material& c = read.model.materials[1];
  EXPECT_EQ(c.normal_scale, 0.5);
  EXPECT_TRUE(c.normal);
  EXPECT_EQ(c.roughness_factor, 0.3);
  EXPECT_EQ(c.metallic_factor, 0.7);
  EXPECT_EQ(c.emissive_factor, (std::array<double, 3>{0, 1, 0}));
}

TEST(ObjRead, NothingIsReadFromOutsideTheFolder) {
  TempFolder folder;
  folder.add("secret.png", test::tiny_png());
  folder.add("inside/a.mtl", "newmtl a\nmap_Kd ../secret.png\n");
  std::filesystem::create_symlink(folder.path() / "secret.png", folder.path() / "inside/link.png");
  folder.add("inside/b.mtl", "newmtl b\nmap_Kd link.png\n");
  folder.add("inside/c.mtl", "newmtl c\nmap_Kd " + (folder.path() / "secret.png").string() + "\n");
  const ReadObj read(
      std::string("mtllib a.mtl b.mtl c.mtl\n") + kObjTriangle +
          "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 3/1\nusemtl c\nf 1/1 2/1 3/1\n",
      folder.path() / "inside");
  EXPECT_TRUE(read.model.images.empty());
  EXPECT_EQ(told(read.context, "missing-image"), 3u);
}

TEST(ObjRead, WhatIsMissingIsToldAndNotAnError) {
  const ReadObj read(std::string("mtllib nowhere.mtl\n") + kObjTriangle + "usemtl lost\nf 1 2 3\n");
  EXPECT_EQ(told(read.context, "missing-material-library"), 1u);
  EXPECT_EQ(told(read.context, "missing-material"), 1u);
  ASSERT_EQ(read.model.materials.size(), 1u);
  EXPECT_EQ(read.model.materials[0].name, "lost");
}

TEST(ObjRead, ImagesWithoutTextureCoordinatesAreLeftOut) {
  TempFolder folder;
  folder.add("p.png", test::tiny_png());
  folder.add("a.mtl", "newmtl a\nKd 1 0 0\nmap_Kd p.png\n");
  const ReadObj read(
      std::string("mtllib a.mtl\n") + kObjTriangle + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\nf 1 2 3\n",
      folder.path());
  ASSERT_EQ(read.model.materials.size(), 2u);
  EXPECT_TRUE(read.model.materials[static_cast<std::size_t>(read.mesh().parts[0].material)].base_color);
  EXPECT_FALSE(read.model.materials[static_cast<std::size_t>(read.mesh().parts[1].material)].base_color);
}

TEST(ObjRead, PointsAndLinesAreDroppedAndTold) {
  const ReadObj read(std::string(kObjTriangle) + "l 1 2\np 3\nf 1 2 3\ncurv 0 1\n");
  EXPECT_EQ(told(read.context, "dropped-lines-points"), 2u);
  EXPECT_EQ(told(read.context, "unknown-statement"), 1u);
}

TEST(ObjRead, ErrorsTellTheLine) {
  expect_obj_refused(std::string(kObjTriangle) + "f 0 1 2\n", "test.obj: line 4", "count from 1");
  expect_obj_refused(std::string(kObjTriangle) + "f 1 2 4\nf 1 2 3\n", "test.obj: line 4",
                     "vertex index 4 but there are 3");
  expect_obj_refused(std::string(kObjTriangle) + "f 1 2 -4\n", "test.obj: line 4");
  expect_obj_refused(std::string(kObjTriangle) + "vt 0 0\nf 1/1 2/2 3/1\n", "test.obj: line 5",
                     "texture coordinate");
  expect_obj_refused(std::string(kObjTriangle) + "f 1 2 3x\n", "test.obj: line 4");
  expect_obj_refused(std::string(kObjTriangle) + "f 1 2 99999999999999999999\n", "test.obj: line 4");
  expect_obj_refused(std::string(kObjTriangle) + "f 1 2 4294967295\n", "test.obj: line 4");
  expect_obj_refused("v 0 0\nf 1 1 1\n", "test.obj: line 1", "three numbers");
  expect_obj_refused("v 0 0 nan\n", "test.obj: line 1", "finite");
  expect_obj_refused("v 0 0 1e99\n", "test.obj: line 1", "finite");
  expect_obj_refused("v 0 \\\n 0 zero\n", "test.obj: line 2");
}

TEST(ObjRead, FilesWithoutFacesAreUnsupported) {
  Context context;
  expect_error([&] { read_obj(bytes_of(kObjTriangle), {}, "test.obj", {}, context); }, ErrorKind::unsupported,
               "test.obj");
}

TEST(ObjRead, LimitsAreKept) {
  ReadOptions options;
  options.max_elements = 2;
  Context context;
  expect_error(
      [&] { read_obj(bytes_of(std::string(kObjTriangle) + "f 1 2 3\n"), {}, "test.obj", options, context); },
      ErrorKind::limit, "test.obj");
}

TEST(ObjRead, Spot) {
  const auto path = test::corpus_file("textured/spot/spot.obj");
  if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
  Context context;
  const Model model = read_model(*path, {}, context);
  EXPECT_EQ(counts(model).triangles, 5856u);
  EXPECT_EQ(counts(model).vertices, 2930u);
  ASSERT_EQ(model.images.size(), 1u);
  EXPECT_EQ(model.images[0].uri, "spot_texture.png");
  EXPECT_EQ(model.meshes[0].surface.source_vertex.size(), 2930u);
  EXPECT_TRUE(context.diagnostics().empty());
}

TEST(ObjRead, ConformanceFiles) {
  struct Case {
    const char* name;
    std::uint64_t triangles, vertices;
  };
  for (const Case& c : {Case{"bowtie-vertex", 2, 5}, Case{"duplicate-and-flipped-faces", 4, 4},
                        Case{"isolated-vertices", 1, 3}, Case{"nonmanifold-edge", 3, 5},
                        Case{"polygons-negative-indices-crlf", 3, 5}}) {
    const auto path = test::corpus_file(std::string("conformance/generated/") + c.name + ".obj");
    if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
    Context context;
    const Model model = read_model(*path, {}, context);
    EXPECT_EQ(counts(model).triangles, c.triangles) << c.name;
    EXPECT_EQ(counts(model).vertices, c.vertices) << c.name;
  }
}

}  // namespace
}  // namespace fovea
