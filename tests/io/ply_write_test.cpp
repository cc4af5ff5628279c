#include "fovea/io/ply_write.h"

#include <gtest/gtest.h>

#include "fovea/io/ply_read.h"
#include "support/corner_soup.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::model_of;
using test::TempFolder;

struct PlyRoundTrip {
  TempFolder folder;
  Context context;
  std::vector<OutputFile> files;
  Model model;
  explicit PlyRoundTrip(const Model& from) {
    files = write_ply(from, "out", context);
    for (const OutputFile& file : files) {
      folder.add(file.name.empty() ? "out.ply" : file.name, test::text_of(file.bytes));
    }
    Context quiet;
    model = read_model(folder.path() / "out.ply", {}, quiet);
    check(model.meshes.at(0).surface);
  }
  std::string text() const { return test::text_of(files.at(0).bytes); }
  const TriMesh& mesh() const { return model.meshes.at(0).surface; }
};

TEST(PlyWrite, RoundTripKeepsEveryBit) {
  for (const TriMesh& mesh : {test::cube(), test::grid(4, 4), test::icosphere(1), test::tetrahedron()}) {
    const PlyRoundTrip trip(model_of(mesh));
    EXPECT_EQ(test::corner_soup(trip.mesh()), test::corner_soup(mesh));
    EXPECT_TRUE(trip.context.diagnostics().empty());
  }
}

TEST(PlyWrite, FieldsAndColoursSurvive) {
  TriMesh mesh = test::single_triangle();
  const std::vector<ValueId> corners = {ValueId{std::size_t{0}}, ValueId{std::size_t{1}},
                                        ValueId{std::size_t{2}}};
  AttributeLayer field, color;
  field.semantic = Semantic::custom;
  field.name = "_quality";
  field.width = 1;
  field.values = {0.1f, -5, 1e20f};
  field.corner_value = corners;
  color.semantic = Semantic::color;
  color.width = 3;
  color.values = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  color.corner_value = corners;
  mesh.layers.push_back(field);
  mesh.layers.push_back(color);
  const PlyRoundTrip trip(model_of(mesh));
  EXPECT_EQ(trip.mesh().find(Semantic::color)->values, color.values);
  EXPECT_EQ(trip.mesh().layers.back().name, "_quality");
  EXPECT_EQ(trip.mesh().layers.back().values, field.values);
  EXPECT_EQ(trip.text().find("alpha"), std::string::npos);
}

TEST(PlyWrite, MirroredInstancesFaceOutwards) {
  Model model = model_of(test::tetrahedron());
  model.nodes[0].scale = {-1, 1, 1};
  const PlyRoundTrip trip(model);
  const auto volume = [](const TriMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
      const auto p = [&](std::size_t k) { return Vec3d(mesh.positions[t[k].index()]); };
      sum += dot(p(0), cross(p(1), p(2)));
    }
    return sum;
  };
  EXPECT_DOUBLE_EQ(volume(trip.mesh()), volume(model.meshes[0].surface));
}

Model textured(std::size_t images) {
  Model model = model_of(test::two_part_grid(2, 2));
  const std::string png = test::tiny_png();
  model.materials.clear();
  for (std::size_t i = 0; i < 2; ++i) {
    Material material;
    material.metallic_factor = 0;
    material.base_color.emplace();
    material.base_color->texture = static_cast<int>(i % images);
    model.materials.push_back(material);
  }
  for (std::size_t i = 0; i < images; ++i) {
    EncodedImage image;
    image.mime_type = "image/png";
    image.uri = "paint " + std::to_string(i) + ".png";
    image.bytes.assign(png.begin(), png.end());
    model.images.push_back(image);
    Texture texture;
    texture.image = static_cast<int>(i);
    model.textures.push_back(texture);
  }
  return model;
}

TEST(PlyWrite, OneBaseColourImageComesAlong) {
  const PlyRoundTrip trip(textured(1));
  ASSERT_EQ(trip.files.size(), 2u);
  EXPECT_EQ(trip.files[1].name, "paint 0.png");
  EXPECT_NE(trip.text().find("comment TextureFile paint 0.png\n"), std::string::npos);
  ASSERT_EQ(trip.model.images.size(), 1u);
  EXPECT_TRUE(trip.model.materials.at(0).base_color);
  EXPECT_TRUE(trip.context.diagnostics().empty());
}

TEST(PlyWrite, SeveralBaseColourImagesAreLostAndTold) {
  Context context;
  const auto files = write_ply(textured(2), "out", context);
  EXPECT_EQ(files.size(), 1u);
  EXPECT_EQ(test::told(context, "lost-on-export"), 1u);
}

TEST(PlyWrite, EmptyModelsGiveAHeader) {
  Context context;
  const auto files = write_ply(Model{}, "out", context);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_NE(test::text_of(files[0].bytes).find("element vertex 0\n"), std::string::npos);
}

}  // namespace
}  // namespace fovea
