#include "fovea/texture/regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/texture_use.h"
#include "fovea/texture/mip_map.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/reading.h"

namespace fovea {
namespace {

/// With these every texel and every triangle is a region.
SegmentOptions finest() {
  SegmentOptions o;
  o.sigma = 0;
  o.k = 0;
  o.min_size = 0;
  return o;
}

ModelRegions regions(const Model& model, const SegmentOptions& options = finest(), int threads = 1) {
  Context context;
  context.threads = threads;
  return model_regions(model, options, context);
}

/// Texels of greys 0, 1, 2, ... in scan order.
Image8 counted(int width, int height) {
  Image8 image(width, height, 1, ColorEncoding::linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<std::uint8_t>(i);
  return image;
}

/// Adds an image with a texture and a material that shows it. Returns the material.
Material& add_textured(Model& model, const Image8& image) {
  EncodedImage encoded;
  encoded.bytes = encode_png(image);
  model.images.push_back(std::move(encoded));
  Texture texture;
  texture.image = static_cast<int>(model.images.size()) - 1;
  model.textures.push_back(texture);
  Material material;
  material.base_color = TextureRef{static_cast<int>(model.textures.size()) - 1, 0, {}};
  model.materials.push_back(std::move(material));
  return model.materials.back();
}

/// `grid(1, 1)` with that material.
TriMesh square(int material) {
  TriMesh mesh = test::grid(1, 1);
  mesh.parts[0].material = material;
  return mesh;
}

Model squares(const std::vector<int>& materials) {
  std::vector<TriMesh> meshes;
  for (const int material : materials) meshes.push_back(square(material));
  Model model = test::model_of(std::move(meshes));
  model.materials.clear();
  return model;
}

/// A strip of `colors.size()` squares side by side, each of one colour; parts as `materials` say.
///
///   +--+--+--+
///   |0/|2/|4/|     Triangles 2 i and 2 i + 1 are square i.
///   |/1|/3|/5|
///   +--+--+--+
TriMesh colored_strip(const std::vector<Vec3f>& colors, const std::vector<int>& materials) {
  std::vector<SplitPart> parts;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (i == 0 || materials[i] != materials[i - 1]) {
      parts.push_back(std::move(test::PartBuilder(materials[i], false).part()));
      parts.back().attributes.push_back({Semantic::color, 0, {}, 3, {}, {}});
    }
    SplitPart& part = parts.back();
    const auto first = static_cast<std::uint32_t>(part.positions.size());
    const auto x = static_cast<float>(i);
    for (const Vec3f p : {Vec3f{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}}) {
      part.positions.push_back(p);
      for (const float c : {colors[i].x, colors[i].y, colors[i].z}) part.attributes[0].values.push_back(c);
    }
    for (const std::uint32_t k : {0u, 2u, 3u, 0u, 1u, 2u}) part.indices.push_back(first + k);
  }
  return test::weld_parts(std::move(parts));
}

/// The region of each triangle of a mesh that looks at no texture.
std::vector<std::uint32_t> of_faces(const ModelRegions& found, const Model& model, std::size_t mesh) {
  std::vector<std::uint32_t> result;
  for (std::size_t f = 0; f < model.meshes[mesh].surface.face_count(); ++f)
    result.push_back(found.region_at(mesh, FaceId{f}, {}));
  return result;
}

using Numbers = std::vector<std::uint32_t>;

//   1 2 3
//   4 5 6
TEST(Regions, EachTexelOfAPictureIsFound) {
  Model model = squares({0});
  add_textured(model, counted(3, 2));
  const ModelRegions found = regions(model);
  EXPECT_EQ(found.count(), 7u);
  EXPECT_EQ(found.part(0, 0).uv_set(), 0);
  EXPECT_EQ(found.region_at(0, FaceId{0}, {0.1f, 0.1f}), 1u);
  EXPECT_EQ(found.region_at(0, FaceId{1}, {0.5f, 0.1f}), 2u);
  EXPECT_EQ(found.region_at(0, FaceId{0}, {0.9f, 0.1f}), 3u);
  EXPECT_EQ(found.region_at(0, FaceId{0}, {0.1f, 0.9f}), 4u);
  EXPECT_EQ(found.region_at(0, FaceId{0}, {0.9f, 0.9f}), 6u);
  // Beyond the border it repeats.
  EXPECT_EQ(found.region_at(0, FaceId{0}, {1.1f, -0.1f}), 4u);
}

TEST(Regions, AreWhereTheRendererSeesTheirTexels) {
  Random random(2);
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    Model model = squares({0});
    Material& material = add_textured(model, counted(5, 3));
    TextureTransform transform;
    transform.offset = {0.3, -1.25};
    transform.rotation_rad = 0.7;
    transform.scale = {2, -1.5};
    material.base_color->transform = transform;
    Sampler sampler;
    sampler.wrap_u = wrap;
    sampler.wrap_v = wrap == Wrap::clamp ? Wrap::mirror : Wrap::clamp;
    sampler.mag_filter = 9728;
    model.samplers = {sampler};
    model.textures[0].sampler = 0;
    const ModelRegions found = regions(model);
    const MipMap map(counted(5, 3), ColorEncoding::linear);
    for (int n = 0; n < 500; ++n) {
      const double u = random.uniform(-3, 3), v = random.uniform(-3, 3);
      const Vec2d at = matrix(transform)({u, v});
      const Vec2f moved{static_cast<float>(at.x), static_cast<float>(at.y)};
      const auto grey = static_cast<std::uint32_t>(std::lround(map.sample(moved, {}, sampler).r * 255));
      // Double and single precision may part at the border of a texel: none of these is so near.
      EXPECT_EQ(found.region_at(0, FaceId{0}, {static_cast<float>(u), static_cast<float>(v)}), 1 + grey);
    }
  }
}

TEST(Regions, CoordinatesOfNoUseFindSome) {
  Model model = squares({0});
  add_textured(model, counted(3, 2));
  const ModelRegions found = regions(model);
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity, 3e38f, -1e7f}) {
    EXPECT_EQ(found.region_at(0, FaceId{0}, {bad, bad}), 1u);
    for (const Vec2f uv : {Vec2f{0.5f, bad}, {bad, 0.9f}}) {
      EXPECT_GE(found.region_at(0, FaceId{0}, uv), 1u);
      EXPECT_LE(found.region_at(0, FaceId{0}, uv), 6u);
    }
  }
}

TEST(Regions, OneTexelIsOneRegion) {
  Model model = squares({0});
  add_textured(model, counted(1, 1));
  const ModelRegions found = regions(model, SegmentOptions{});
  EXPECT_EQ(found.count(), 2u);
  for (const float u : {-1.0f, 0.0f, 0.3f, 1.0f}) EXPECT_EQ(found.region_at(0, FaceId{0}, {u, u}), 1u);
}

TEST(Regions, MaterialsOfOneColorShareThoseOfAnImage) {
  Model model = squares({0, 1, 2, 3});
  add_textured(model, counted(2, 1));
  Material tinted = model.materials[0];
  tinted.base_color_factor = {1, 0, 0, 1};
  model.materials.push_back(tinted);
  add_textured(model, counted(3, 1));
  model.materials.push_back(model.materials[0]);
  model.textures.push_back(model.textures[0]);  // another texture of the first image
  model.materials[3].base_color->texture = 2;
  const ModelRegions found = regions(model);
  EXPECT_EQ(found.count(), 1u + 2 + 2 + 3);
  const auto at = [&](std::size_t mesh) { return found.region_at(mesh, FaceId{0}, {0.9f, 0.5f}); };
  EXPECT_EQ(at(0), 2u);
  EXPECT_EQ(at(1), 4u);  // of another colour
  EXPECT_EQ(at(2), 7u);
  EXPECT_EQ(at(3), 2u);
}

TEST(Regions, WithoutTexturesFactorsAreRegions) {
  Model model = squares({0, 1, 2, -1});
  model.materials.resize(3);
  model.materials[0].base_color_factor = {1, 0, 0, 1};
  model.materials[1].base_color_factor = {0, 1, 0, 1};
  model.materials[2].base_color_factor = {1, 0, 0, 1};
  model.materials[2].roughness_factor = 0.1;
  const ModelRegions found = regions(model);
  EXPECT_EQ(found.count(), 4u);
  EXPECT_EQ(of_faces(found, model, 0), (Numbers{1, 1}));
  EXPECT_EQ(of_faces(found, model, 1), (Numbers{2, 2}));
  EXPECT_EQ(of_faces(found, model, 2), (Numbers{1, 1}));
  EXPECT_EQ(of_faces(found, model, 3), (Numbers{3, 3}));
  EXPECT_EQ(found.part(0, 0).uv_set(), -1);
}

TEST(Regions, PartsOfAMeshHaveTheirOwn) {
  Model model = test::model_of(test::two_part_grid(2, 1));
  model.materials.clear();
  add_textured(model, counted(4, 1));
  model.materials.emplace_back();
  const ModelRegions found = regions(model);
  EXPECT_EQ(found.count(), 6u);
  const TriMesh& mesh = model.meshes[0].surface;
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    EXPECT_EQ(found.region_at(0, FaceId{f}, {0.3f, 0}), mesh.face_part[f] == 0 ? 2u : 5u);
}

TEST(Regions, ImagesThatCannotBeDecodedAreAbsent) {
  Model model = squares({0, 1});
  add_textured(model, counted(4, 1));
  add_textured(model, counted(2, 1));
  model.images[0].bytes = {1, 2, 3};
  Context context;
  const ModelRegions found = model_regions(model, finest(), context);
  EXPECT_EQ(test::told(context, "image-not-shown"), 1u);
  EXPECT_EQ(context.diagnostics()[0].place, "/images/0");
  EXPECT_EQ(found.count(), 4u);
  EXPECT_EQ(of_faces(found, model, 0), (Numbers{1, 1}));
  EXPECT_EQ(found.region_at(1, FaceId{0}, {0.9f, 0}), 3u);
}

TEST(Regions, TexturesThatDoNotLieOnTheMeshAreAbsent) {
  Model model = squares({0, 1, 2});
  add_textured(model, counted(4, 1)).base_color->uv_set = 1;
  add_textured(model, counted(4, 1));
  model.textures[1].image = -1;
  add_textured(model, counted(4, 1)).base_color->texture = -1;
  const ModelRegions found = regions(model);
  EXPECT_EQ(found.count(), 2u);
  for (std::size_t m = 0; m < 3; ++m) EXPECT_EQ(of_faces(found, model, m), (Numbers{1, 1}));
}

TEST(Regions, VertexColorsAreSegmentedOverTheMesh) {
  const Vec3f red{1, 0, 0}, blue{0, 0, 1};
  Model model = test::model_of(colored_strip({red, red, blue, red}, {-1, -1, -1, -1}));
  SegmentOptions o = finest();
  o.k = 1;
  const ModelRegions found = regions(model, o);
  EXPECT_EQ(found.count(), 4u);
  EXPECT_EQ(of_faces(found, model, 0), (Numbers{1, 1, 1, 1, 2, 2, 3, 3}));
  // The blue square has two triangles: fewer than three join the first neighbour by number.
  o.min_size = 3;
  EXPECT_EQ(of_faces(regions(model, o), model, 0), (Numbers{1, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(Regions, VertexColorsAreComparedAsDisplayValues) {
  // Light of 0.2140 is the display value 127.5 of 255: nearer to white than it is as light.
  Model model = test::model_of(colored_strip({{0.2140411f, 1, 1}, {1, 1, 1}}, {-1, -1}));
  SegmentOptions o = finest();
  // Two triangles on each side: they join if 127.5 < k / 2.
  o.k = 254.9;
  EXPECT_EQ(regions(model, o).count(), 3u);
  o.k = 255.1;
  EXPECT_EQ(regions(model, o).count(), 2u);
}

TEST(Regions, FactorsMultiplyVertexColors) {
  // Half of white in one material is grey in another: one region across both; a third material differs.
  Model model = test::model_of(colored_strip({{1, 1, 1}, {0.5f, 0.5f, 0.5f}, {1, 1, 1}}, {0, 1, 2}));
  model.materials[0].base_color_factor = {0.5, 0.5, 0.5, 1};
  SegmentOptions o = finest();
  o.k = 1;
  EXPECT_EQ(of_faces(regions(model, o), model, 0), (Numbers{1, 1, 1, 1, 2, 2}));
}

TEST(Regions, WhiteVertexColorsAreNone) {
  Model model = test::model_of(colored_strip({{1, 1, 1}, {1, 1, 1}}, {0, 1}));
  model.materials[1].base_color_factor = {1, 0, 1, 1};
  EXPECT_EQ(of_faces(regions(model), model, 0), (Numbers{1, 1, 2, 2}));
}

TEST(Regions, VertexColorsThatAreNoColorsAreSome) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  Model model = test::model_of(
      colored_strip({{nan, nan, nan}, {-5, -infinity, 0}, {infinity, 9, 1}, {1, 1, 1}}, {-1, -1, -1, -1}));
  SegmentOptions o = finest();
  o.k = 1;
  EXPECT_EQ(of_faces(regions(model, o), model, 0), (Numbers{1, 1, 1, 1, 2, 2, 2, 2}));
}

TEST(Regions, ModelsOfAnyKindHaveThem) {
  EXPECT_EQ(regions(Model()).count(), 1u);
  for (test::NamedMesh& named : test::all_families()) {
    const Model model = test::model_of(std::move(named.mesh));
    const ModelRegions found = regions(model);
    for (const std::uint32_t region : of_faces(found, model, 0)) {
      EXPECT_GT(region, kBackground) << named.name;
      EXPECT_LT(region, found.count()) << named.name;
    }
  }
}

TEST(Regions, StayWhenTheyAreMoved) {
  Model model = squares({0});
  add_textured(model, counted(3, 2));
  ModelRegions found = regions(model);
  const ModelRegions moved = std::move(found);
  EXPECT_EQ(moved.region_at(0, FaceId{0}, {0.9f, 0.9f}), 6u);
}

TEST(Regions, LargeImagesAreReduced) {
  Model model = squares({0});
  Image8 image(4, 2, 1, ColorEncoding::srgb);
  add_textured(model, image);
  SegmentOptions o = finest();
  o.most_texels = 7;
  const ModelRegions found = regions(model, o);  // 2 × 1
  EXPECT_EQ(found.count(), 3u);
  EXPECT_EQ(found.region_at(0, FaceId{0}, {0.49f, 0.9f}), 1u);
  EXPECT_EQ(found.region_at(0, FaceId{0}, {0.51f, 0.1f}), 2u);
}

TEST(Regions, TheSameForAnyNumberOfThreads) {
  std::vector<Vec3f> colors;
  Random random(6);
  for (int i = 0; i < 2000; ++i)
    colors.push_back({static_cast<float>(random.uniform()), static_cast<float>(random.uniform()), 0});
  std::vector<TriMesh> meshes;
  meshes.push_back(square(0));
  meshes.push_back(colored_strip(colors, std::vector<int>(colors.size(), 1)));
  Model model = test::model_of(std::move(meshes));
  model.materials.clear();
  add_textured(model, test::distorted(test::pattern(200, 100)));
  model.materials.emplace_back();
  const ModelRegions one = regions(model, SegmentOptions{}, 1), three = regions(model, SegmentOptions{}, 3);
  EXPECT_EQ(one.count(), three.count());
  EXPECT_EQ(of_faces(one, model, 1), of_faces(three, model, 1));
  for (int n = 0; n < 1000; ++n) {
    const Vec2f uv{static_cast<float>(random.uniform()), static_cast<float>(random.uniform())};
    EXPECT_EQ(one.region_at(0, FaceId{0}, uv), three.region_at(0, FaceId{0}, uv));
  }
}

TEST(Regions, CanBeCancelled) {
  Model model = squares({0});
  add_textured(model, counted(3, 2));
  Context context;
  context.cancel();
  test::expect_error([&] { model_regions(model, SegmentOptions{}, context); }, ErrorKind::cancelled, "");
}

TEST(Regions, RefuseOptionsOutOfRange) {
  SegmentOptions o;
  o.k = -1;
  test::expect_error([&] { regions(Model(), o); }, ErrorKind::usage, "");
}

}  // namespace
}  // namespace fovea
