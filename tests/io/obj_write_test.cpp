#include "fovea/io/obj_write.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fovea/io/obj_read.h"
#include "support/corner_soup.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::model_of;
using test::TempFolder;
using test::told;

/// Writes a model into a folder and reads it again.
struct RoundTrip {
  TempFolder folder;
  Context context;
  std::vector<OutputFile> files;
  Model model;
  explicit RoundTrip(const Model& from) {
    files = write_obj(from, "out", context);
    for (const OutputFile& file : files) {
      folder.add(file.name.empty() ? "out.obj" : file.name, test::text_of(file.bytes));
    }
    Context quiet;
    model = read_model(folder.path() / "out.obj", {}, quiet);
    check(model.meshes.at(0).surface);
  }
  std::string text() const { return test::text_of(files.at(0).bytes); }
  const TriMesh& mesh() const { return model.meshes.at(0).surface; }
};

std::size_t count_lines(const std::string& text, const std::string& begin) {
  std::size_t count = 0;
  for (std::size_t at = text.find(begin); at != text.npos; at = text.find(begin, at + 1)) {
    count += at == 0 || text[at - 1] == '\n';
  }
  return count;
}

double volume(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto p = [&](std::size_t k) { return Vec3d(mesh.positions[t[k].index()]); };
    sum += dot(p(0), cross(p(1), p(2))) / 6;
  }
  return sum;
}

TEST(ObjWrite, RoundTripKeepsEveryBit) {
  // v → 1 - v → v keeps the bits of the cube's and grid's coordinates, which are multiples of 1/8.
  for (const TriMesh& mesh :
       {test::cube(), test::grid(4, 4), test::wavy_grid(8, 8, 0.3), test::tetrahedron()}) {
    const RoundTrip trip(model_of(mesh));
    EXPECT_EQ(test::corner_soup(trip.mesh()), test::corner_soup(mesh));
    EXPECT_TRUE(trip.context.diagnostics().empty());
  }
}

TEST(ObjWrite, SeamsCutOnlyTheirOwnTable) {
  const TriMesh mesh = test::open_cylinder(8, 2);
  const RoundTrip trip(model_of(mesh));
  EXPECT_EQ(count_lines(trip.text(), "v "), mesh.vertex_count());
  EXPECT_EQ(count_lines(trip.text(), "vt "), mesh.vertex_count() + 3);  // the seam has three vertices
  EXPECT_EQ(count_lines(trip.text(), "vn "), mesh.vertex_count());
}

TEST(ObjWrite, NumbersAreShortAndExact) {
  TriMesh mesh = test::single_triangle();
  mesh.positions = {
      {0.1f, -0.0f, 1e-30f}, {1.0f / 3, 123456.79f, 1}, {std::numeric_limits<float>::max(), 3, 2}};
  const RoundTrip trip(model_of(mesh));
  EXPECT_NE(trip.text().find("v 0.1 0 1e-30\n"), std::string::npos);
  EXPECT_NE(trip.text().find("v 0.33333334 123456.79 1\n"), std::string::npos);
  EXPECT_EQ(test::corner_soup(trip.mesh()), test::corner_soup(mesh));
}

TEST(ObjWrite, InstancesAreWrittenWithTheirTransforms) {
  Model model = model_of(test::icosphere(1));
  model.nodes[0].translation = {10, 0, 0};
  model.nodes.push_back(model.nodes[0]);
  model.nodes[1].translation = {0, 0, 0};
  model.nodes[1].scale = {2, 2, -2};  // mirrored
  model.scenes[0].nodes = {0, 1};
  const RoundTrip trip(model);
  EXPECT_EQ(trip.mesh().face_count(), 2 * model.meshes[0].surface.face_count());
  // Mirrored or not, the surface faces outwards: 1 + 2³ times the volume. The translated copy rounds at
  // 10 · 2⁻²⁴ per coordinate.
  EXPECT_NEAR(volume(trip.mesh()), 9 * volume(model.meshes[0].surface), 1e-4);
  const AttributeLayer* normals = trip.mesh().find(Semantic::normal);
  ASSERT_TRUE(normals);
  for (std::size_t f = 0; f < trip.mesh().face_count(); ++f) {
    const auto& t = trip.mesh().triangles[f];
    const auto p = [&](std::size_t k) { return Vec3d(trip.mesh().positions[t[k].index()]); };
    const float* n = normals->value(normals->corner_value[3 * f]);
    EXPECT_GT(dot(cross(p(1) - p(0), p(2) - p(0)), Vec3d(n[0], n[1], n[2])), 0);
  }
}

TEST(ObjWrite, InstancesShareTextureCoordinates) {
  Model model = model_of(test::grid(2, 2));
  model.nodes.push_back(model.nodes[0]);
  model.nodes[1].translation = {5, 0, 0};
  model.scenes[0].nodes = {0, 1};
  const RoundTrip trip(model);
  EXPECT_EQ(count_lines(trip.text(), "vt "), 9u);
  EXPECT_EQ(count_lines(trip.text(), "v "), 18u);
}

TEST(ObjWrite, NormalsOfUnevenScalesStayUpright) {
  Model model = model_of(test::icosphere(2));
  model.nodes[0].scale = {1, 1, 5};
  const RoundTrip trip(model);
  const AttributeLayer* normals = trip.mesh().find(Semantic::normal);
  for (std::size_t c = 0; c < 3 * trip.mesh().face_count(); ++c) {
    const Vec3d p(trip.mesh().positions[trip.mesh().vertex(CornerId{c}).index()]);
    const float* n = normals->value(normals->corner_value[c]);
    // The gradient of x² + y² + (z / 5)² at the stretched sphere's point.
    const Vec3d expected = normalized(Vec3d{p.x, p.y, p.z / 25});
    // The sphere's float normals and positions differ from each other by some 2⁻²³, five times stretched.
    EXPECT_NEAR(length(Vec3d(n[0], n[1], n[2]) - expected), 0, 2e-6);
  }
}

TEST(ObjWrite, MaterialsAndImagesRoundTrip) {
  Model model = model_of(test::two_part_grid(4, 2));
  const std::string png = test::tiny_png();
  EncodedImage image;
  image.mime_type = "image/png";
  image.uri = "maps/colour.png";
  image.bytes.assign(png.begin(), png.end());
  model.images = {image};
  Texture texture;
  texture.image = 0;
  model.textures = {texture};
  Material plain, shiny;
  plain.name = "same name";
  plain.base_color_factor = {0.25, 0.5, 1, 0.5};
  plain.alpha_mode = AlphaMode::blend;
  plain.metallic_factor = 0;
  plain.roughness_factor = 0.75;
  shiny.name = "same name";
  shiny.base_color.emplace();
  shiny.base_color->texture = 0;
  shiny.normal = shiny.base_color;
  shiny.normal_scale = 0.5;
  shiny.emissive_factor = {1, 0.5, 0};
  shiny.metallic_factor = 0.5;
  shiny.roughness_factor = 0.25;
  model.materials = {plain, shiny};
  const RoundTrip trip(model);
  ASSERT_EQ(trip.model.materials.size(), 2u);
  const Material &a = trip.model.materials[0], &b = trip.model.materials[1];
  EXPECT_EQ(a.name, "same_name");
  EXPECT_EQ(b.name, "same_name_2");
  EXPECT_EQ(a.base_color_factor, plain.base_color_factor);
  EXPECT_EQ(a.alpha_mode, AlphaMode::blend);
  EXPECT_EQ(a.roughness_factor, 0.75);
  EXPECT_EQ(b.metallic_factor, 0.5);
  EXPECT_EQ(b.roughness_factor, 0.25);
  EXPECT_EQ(b.emissive_factor, shiny.emissive_factor);
  EXPECT_TRUE(b.base_color);
  EXPECT_TRUE(b.normal);
  EXPECT_EQ(b.normal_scale, 0.5);
  ASSERT_EQ(trip.model.images.size(), 1u);
  EXPECT_EQ(trip.model.images[0].uri, "maps/colour.png");
  EXPECT_EQ(trip.model.images[0].bytes, image.bytes);
}

TEST(ObjWrite, TextureTransformsAreWorkedIn) {
  Model model = model_of(test::grid(1, 1));
  model.meshes[0].surface.parts[0].material = 0;
  Material material;
  material.base_color.emplace();
  material.base_color->texture = 0;
  // A quarter turn: (u, v) → (0.5 + 2 v, -2 u), counted from the top left.
  material.base_color->transform = TextureTransform{{0.5, 0}, std::acos(-1.0) / 2, {2, 2}};
  model.materials = {material};
  model.textures.emplace_back();
  const RoundTrip trip(model);
  const AttributeLayer* uv = trip.mesh().find(Semantic::uv);
  ASSERT_TRUE(uv);
  for (std::size_t c = 0; c < 6; ++c) {
    const Vec3f p = trip.mesh().positions[trip.mesh().vertex(CornerId{c}).index()];
    const float* x = uv->value(uv->corner_value[c]);
    // The grid's uv are its x and y. Floats near 2 carry 2⁻²³ twice (there and back).
    EXPECT_NEAR(x[0], 0.5 + 2 * p.y, 5e-7);
    EXPECT_NEAR(x[1], -2 * p.x, 5e-7);
  }
}

TEST(ObjWrite, WhatIsLostIsOneDiagnostic) {
  Model model = model_of(test::single_triangle());
  model.skins.emplace_back();
  model.animations.resize(2);
  Context context;
  write_obj(model, "out", context);
  ASSERT_EQ(context.diagnostics().size(), 1u);
  EXPECT_EQ(context.diagnostics()[0].code, "lost-on-export");
  EXPECT_NE(context.diagnostics()[0].message.find("1 skins, 2 animations"), std::string::npos);
}

TEST(ObjWrite, VertexColoursComeBack) {
  TriMesh mesh = test::single_triangle();
  AttributeLayer color;
  color.semantic = Semantic::color;
  color.width = 3;
  color.values = {1, 0, 0.25f, 0.5f, 0.5f, 0.5f, 0, 0.001f, 1};
  color.corner_value = {ValueId{std::size_t{0}}, ValueId{std::size_t{1}}, ValueId{std::size_t{2}}};
  mesh.layers.push_back(color);
  const RoundTrip trip(model_of(mesh));
  const AttributeLayer* back = trip.mesh().find(Semantic::color);
  ASSERT_TRUE(back);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      // Through the sRGB curve and back: a few units in the last of 24 bits.
      EXPECT_NEAR(back->value(back->corner_value[c])[k], color.values[3 * c + k], 1e-6);
    }
  }
}

TEST(ObjWrite, EmptyModelsGiveEmptyFiles) {
  Context context;
  const auto files = write_obj(Model{}, "out", context);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_TRUE(files[0].bytes.empty());
}

}  // namespace
}  // namespace fovea
