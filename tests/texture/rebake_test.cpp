#include "fovea/texture/rebake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "fovea/io/image_codec.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/shrink.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/reading.h"
#include "support/textured.h"

namespace fovea {
namespace {

constexpr double kAmplitude = 0.04;

/// A bumpy square over [0, 1]², and a flat one with badly fitted coordinates: u = 0.1 + 0.8 x.
struct Squares {
  Model original, simplified;
};
Squares flat_and_wavy(int images) {
  Squares s{test::textured(test::wavy_grid(48, 48, kAmplitude), images),
            test::textured(test::wavy_grid(1, 1, kAmplitude), images)};
  TriMesh& flat = s.simplified.meshes[0].surface;
  AttributeLayer& uv = *flat.find(Semantic::uv);
  for (std::size_t i = 0; i < uv.values.size(); i += 2) uv.values[i] = 0.1f + 0.8f * uv.values[i];
  AttributeLayer& normals = *flat.find(Semantic::normal);
  for (std::size_t i = 0; i < normals.values.size(); ++i) normals.values[i] = i % 3 == 2 ? 1 : 0;
  return s;
}

ShrinkOptions rebake_of(const Model& original, bool normals = false) {
  ShrinkOptions options;
  options.moves = TexelMoves::none;
  options.rebake = {&original, normals};
  return options;
}

Shrunk rebaked(const Model& model, const ShrinkOptions& options, int threads = 1) {
  Context context;
  context.threads = threads;
  return shrink_textures(model, options, {}, context);
}

/// The normal of the bumpy square.
Vec3d normal_at(double x, double y) {
  const double w = 2 * std::numbers::pi;
  return normalized(Vec3d{-kAmplitude * w * std::cos(w * x) * std::sin(w * y),
                          -kAmplitude * w * std::sin(w * x) * std::cos(w * y), 1});
}

TEST(Rebake, OneImageThatCannotBeReadLosesNoOther) {
  Squares s = flat_and_wavy(2);
  for (Model* model : {&s.original, &s.simplified})
    model->images[1].bytes.resize(model->images[1].bytes.size() / 2);
  ShrinkOptions options = rebake_of(s.original);
  options.output.format = TextureOutput::webp;
  const Shrunk found = rebaked(s.simplified, options);
  EXPECT_EQ(found.images[0].after.mime_type, "image/webp");
  EXPECT_NE(found.model.images[0].bytes, s.simplified.images[0].bytes);
  EXPECT_EQ(found.model.images[1], s.simplified.images[1]);
  EXPECT_NE(found.images[1].kept_because, "");
  EXPECT_GT(found.atlases.at(0).rebaked_texels, 0.5);
}

TEST(Rebake, FilesDoNotGrowAndWhatShowsNoMoreStays) {
  const Squares s = flat_and_wavy(1);
  const Shrunk same = rebaked(s.original, rebake_of(s.original));
  EXPECT_EQ(same.model.images, s.original.images);
  EXPECT_NE(same.images[0].kept_because, "");
  const Shrunk baked = rebaked(s.simplified, rebake_of(s.original));
  EXPECT_LE(baked.model.images[0].bytes.size(), s.simplified.images[0].bytes.size());
}

TEST(Rebake, NormalsBecomeAMapWhereThereIsNone) {
  const Squares s = flat_and_wavy(1);
  const Shrunk found = rebaked(s.simplified, rebake_of(s.original, true));
  const Model& model = found.model;
  // Elements are only added.
  ASSERT_EQ(model.images.size(), 2u);
  ASSERT_EQ(model.textures.size(), 2u);
  EXPECT_EQ(model.textures[0].image, 0);
  ASSERT_TRUE(model.materials[0].normal);
  EXPECT_EQ(model.materials[0].normal->texture, 1);
  ASSERT_EQ(found.images.size(), 2u);
  EXPECT_EQ(found.images[1].before.bytes, 0u);
  check(model.meshes[0].surface);
  const AttributeLayer* tangents = model.meshes[0].surface.find(Semantic::tangent);
  ASSERT_NE(tangents, nullptr);
  // u runs along x, v along y, so that the bitangent runs against y: cross(z, x) · -1.
  EXPECT_NEAR(static_cast<double>(tangents->values[0]), 1, 1e-6);
  EXPECT_EQ(tangents->values[3], -1);
  const Image8 map = decode_image(model.images[1].bytes);
  for (int y = 2; y < 62; y += 5) {
    for (int x = 8; x < 56; x += 3) {
      const Vec3d n = normal_at(((x + 0.5) / 64 - 0.1) / 0.8, (y + 0.5) / 64);
      // A step of the file is 1 / 127.5; the square's triangles bend its normals by a little.
      EXPECT_NEAR(map.at(x, y)[0] / 127.5 - 1, n.x, 0.015) << x << ' ' << y;
      EXPECT_NEAR(map.at(x, y)[1] / 127.5 - 1, -n.y, 0.015) << x << ' ' << y;
    }
  }
}

TEST(Rebake, WhoHasAMapGetsNoTangents) {
  Squares s = flat_and_wavy(2);
  const Shrunk found = rebaked(s.simplified, rebake_of(s.original, true));
  EXPECT_EQ(found.model.images.size(), s.simplified.images.size());
  EXPECT_EQ(found.model.meshes[0].surface.find(Semantic::tangent), nullptr);
}

TEST(Rebake, NormalsTakeTheOldMapAlong) {
  // A map that leans along u everywhere, on a flat original: the normals of the result lean as well.
  Squares s = flat_and_wavy(2);
  Image8 leaning(32, 32, 3, ColorEncoding::linear);
  for (std::size_t i = 0; i < leaning.pixels.size(); i += 3)
    leaning.pixels[i] = 204, leaning.pixels[i + 1] = 128, leaning.pixels[i + 2] = 230;
  for (Model* model : {&s.original, &s.simplified}) model->images[1].bytes = encode_png(leaning);
  Atlas before = find_atlases(s.original).at(0), after = find_atlases(s.simplified).at(0);
  AtlasRebake rebake(s.original, before, s.simplified, after);
  const Image8 map = rebake.baked_normals(&leaning, 1, 32, 32, Context());
  for (int y = 1; y < 31; y += 3) {
    for (int x = 5; x < 27; x += 2) {
      const Vec3d n = normal_at(((x + 0.5) / 32 - 0.1) / 0.8, (y + 0.5) / 32);
      const Vec3d t = normalized(Vec3d{1, 0, 0} - n * n.x), b = -cross(n, t);
      const Vec3d wanted = normalized(t * (204 / 127.5 - 1) + b * (128 / 127.5 - 1) + n * (230 / 127.5 - 1));
      EXPECT_NEAR(map.at(x, y)[0] / 127.5 - 1, wanted.x, 0.02);
      EXPECT_NEAR(map.at(x, y)[1] / 127.5 - 1, -wanted.y, 0.02);
    }
  }
  // A material that doubles the map stores half.
  const Image8 half = rebake.baked_normals(nullptr, 2, 32, 32, Context());
  const Image8 full = rebake.baked_normals(nullptr, 1, 32, 32, Context());
  const double slope = (full.at(16, 3)[1] - 127.5) / (full.at(16, 3)[2] - 127.5);
  EXPECT_NEAR((half.at(16, 3)[1] - 127.5) / (half.at(16, 3)[2] - 127.5), slope / 2, 0.02);
}

TEST(Rebake, NormalsGoIntoTheMapThatThereIs) {
  Squares s = flat_and_wavy(2);
  // Nothing but noise, so that the file has bytes to lose.
  Image8 noisy(64, 64, 3, ColorEncoding::linear);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < noisy.pixels.size(); ++i)
    noisy.pixels[i] = i % 3 == 2 ? 255 : static_cast<std::uint8_t>(124 + random() % 8);
  for (Model* model : {&s.original, &s.simplified}) model->images[1].bytes = encode_png(noisy);
  ShrinkOptions options = rebake_of(s.original);
  options.scale = 0.5;
  const Shrunk found = rebaked(s.simplified, options);
  EXPECT_EQ(found.model.images.size(), 2u);
  const Image8 map = decode_image(found.model.images[1].bytes);
  ASSERT_EQ(map.width, 32);
  for (int y = 2; y < 30; y += 3) {
    for (int x = 5; x < 27; x += 2) {
      const Vec3d n = normal_at(((x + 0.5) / 32 - 0.1) / 0.8, (y + 0.5) / 32);
      // Noise of 4 / 127.5 halves when it is made smaller.
      EXPECT_NEAR(map.at(x, y)[0] / 127.5 - 1, n.x, 0.03) << x << ' ' << y;
      EXPECT_NEAR(map.at(x, y)[1] / 127.5 - 1, -n.y, 0.03) << x << ' ' << y;
    }
  }
  // What is shaded flat has no normals to bake: the map stays what it was, made smaller.
  std::erase_if(s.simplified.meshes[0].surface.layers,
                [](const AttributeLayer& layer) { return layer.semantic == Semantic::normal; });
  const Image8 flat = decode_image(rebaked(s.simplified, options).model.images[1].bytes);
  EXPECT_NEAR(flat.at(10, 1)[1], 127.5, 4);
  EXPECT_GT(std::abs(map.at(10, 1)[1] - 127.5), 10);
}

/// Two of the squares in one place and in one image, side by side there: the bumps of the second go the other
/// way.
Squares two_meshes() {
  Squares s = flat_and_wavy(1);
  for (Model* model : {&s.original, &s.simplified}) {
    Mesh second = model->meshes[0];
    for (Vec3f& p : second.surface.positions) p.z = -p.z;
    AttributeLayer& normals = *second.surface.find(Semantic::normal);
    for (std::size_t i = 0; i < normals.values.size(); ++i) {
      if (i % 3 != 2) normals.values[i] = -normals.values[i];
    }
    for (Mesh* mesh : {&model->meshes[0], &second}) {
      AttributeLayer& uv = *mesh->surface.find(Semantic::uv);
      for (std::size_t i = 0; i < uv.values.size(); i += 2)
        uv.values[i] = 0.5f * uv.values[i] + (mesh == &second ? 0.5f : 0);
    }
    model->meshes.push_back(std::move(second));
    Node node = model->nodes[0];
    node.mesh = 1;
    model->nodes.push_back(node);
    model->scenes[0].nodes.push_back(1);
  }
  return s;
}

TEST(Rebake, EachMeshLooksAtItsOwnSurface) {
  const Squares s = two_meshes();
  Atlas before = find_atlases(s.original).at(0), after = find_atlases(s.simplified).at(0);
  AtlasRebake rebake(s.original, before, s.simplified, after);
  const Image8 map = rebake.baked_normals(nullptr, 1, 128, 64, Context());
  for (int y = 2; y < 62; y += 5) {
    for (int x = 8; x < 56; x += 3) {
      const Vec3d n = normal_at(((x + 0.5) / 64 - 0.1) / 0.8, (y + 0.5) / 64);
      EXPECT_NEAR(map.at(x, y)[0] / 127.5 - 1, n.x, 0.015) << x << ' ' << y;
      EXPECT_NEAR(map.at(x, y)[1] / 127.5 - 1, -n.y, 0.015) << x << ' ' << y;
      EXPECT_NEAR(map.at(x + 64, y)[0] / 127.5 - 1, -n.x, 0.015) << x << ' ' << y;
      EXPECT_NEAR(map.at(x + 64, y)[1] / 127.5 - 1, n.y, 0.015) << x << ' ' << y;
    }
  }
}

TEST(Rebake, ImagesOfVariantsAreBakedToo) {
  Squares s = flat_and_wavy(1);
  for (Model* model : {&s.original, &s.simplified}) {
    Image8 other = decode_image(model->images[0].bytes);
    for (std::uint8_t& value : other.pixels) value = static_cast<std::uint8_t>(255 - value);
    model->images.push_back(model->images[0]);
    model->images[1].bytes = encode_png(other);
    model->textures.push_back({1, -1, "", ""});
    model->materials.push_back(model->materials[0]);
    model->materials[1].base_color = TextureRef{1, 0, {}};
    model->meshes[0].surface.parts[0].json =
        R"({"extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}})";
  }
  ShrinkOptions options = rebake_of(s.original);
  options.output.format = TextureOutput::png;
  options.output.psnr_db = 100;
  options.scale = 0.5;
  const Shrunk found = rebaked(s.simplified, options);
  const Image8 own = decode_image(found.model.images[0].bytes),
               other = decode_image(found.model.images[1].bytes);
  ASSERT_EQ(other.width, own.width);
  ASSERT_GT(found.atlases.at(0).rebaked_texels, 0.5);
  // The variant's image is the negative of the other one, and stays so to rounding.
  int off = 0;
  for (std::size_t i = 0; i < own.pixels.size(); ++i)
    off = std::max(off, std::abs(own.pixels[i] + other.pixels[i] - 255));
  EXPECT_LE(off, 16) << "averages in linear light of a negative differ by that much";
}

TEST(Rebake, WhatIsBakedSharesTheBytes) {
  // A new normal map, which takes what detail it has, and a picture.
  const Squares s = flat_and_wavy(1);
  ShrinkOptions options = rebake_of(s.original, true);
  const Shrunk all = rebaked(s.simplified, options);
  options.max_bytes = static_cast<std::int64_t>(all.bytes) / 4;
  const Shrunk found = rebaked(s.simplified, options);
  EXPECT_LE(found.bytes, all.bytes / 4);
  EXPECT_GT(found.bytes, all.bytes / 12);
  ASSERT_EQ(found.images.size(), 2u);
  EXPECT_EQ(found.images[1].before.bytes, 0u);
  EXPECT_GT(found.images[1].after.bytes, 0u);
  EXPECT_GT(found.atlases.at(0).rebaked_texels, 0.5);
  EXPECT_EQ(found.images[0].after.mime_type, "image/png");
}

TEST(Rebake, AFileThatCannotBeSmallerStays) {
  Squares s = flat_and_wavy(1);
  Image8 tiny(2, 2, 3, ColorEncoding::srgb);
  tiny.at(0, 0)[0] = 200;
  for (Model* model : {&s.original, &s.simplified}) model->images[0].bytes = encode_png(tiny);
  ShrinkOptions options = rebake_of(s.original);
  options.max_bytes = 10;
  const Shrunk found = rebaked(s.simplified, options);
  EXPECT_LE(found.model.images[0].bytes.size(), s.original.images[0].bytes.size());
  EXPECT_EQ(found.bytes, found.model.images[0].bytes.size());
}

TEST(Rebake, WhatIsBakedIsFilledBetweenCharts) {
  const Model model = test::small_charts(80);
  ShrinkOptions options = rebake_of(model);
  options.scale = 0.5;
  options.output.format = TextureOutput::png;
  const Atlas atlas = find_atlases(model).at(0);
  Image8 image =
      AtlasRebake(model, atlas, model, atlas).baked(decode_image(model.images[0].bytes), {}, Context());
  const auto half = [&] { return resized(image, 40, 40, {}, Wrap::repeat, Wrap::repeat, {}).pixels; };
  const std::vector<std::uint8_t> unfilled = half();
  fill_between(image, atlas_faces(model, atlas), {});
  const std::vector<std::uint8_t> filled = half();
  ASSERT_NE(filled, unfilled);
  EXPECT_EQ(decode_image(rebaked(model, options).model.images[0].bytes).pixels, filled);
}

TEST(Rebake, MovesAndBakesAtOnce) {
  const Squares s = flat_and_wavy(1);
  ShrinkOptions options = rebake_of(s.original);
  options.moves = TexelMoves::balanced;
  options.scale = 0.25;
  options.output.format = TextureOutput::webp;
  const Shrunk one = rebaked(s.simplified, options), three = rebaked(s.simplified, options, 3);
  EXPECT_EQ(one.images[0].after.width, 16) << one.images[0].kept_because;
  EXPECT_GT(one.atlases.at(0).rebaked_texels, 0.5);
  EXPECT_EQ(one.model.images[0].bytes, three.model.images[0].bytes);
  options.rebake.new_normal_maps = true;
  EXPECT_EQ(rebaked(s.simplified, options).model.images[1].bytes,
            rebaked(s.simplified, options, 3).model.images[1].bytes);
}

TEST(Rebake, AnyMeshComesThrough) {
  for (const auto& [name, mesh] : test::all_families()) {
    const Model model = test::textured(mesh, 1);
    ShrinkOptions options = rebake_of(model, true);
    options.scale = 0.5;
    const Shrunk found = rebaked(model, options);
    for (const Mesh& m : found.model.meshes) EXPECT_NO_THROW(check(m.surface)) << name;
    EXPECT_EQ(found.images.size(), found.model.images.size()) << name;
  }
}

TEST(Rebake, AnImageWhoseTrianglesAllWentStays) {
  const Model original = test::textured(test::two_part_grid(2, 1), 1);
  Model simplified = original;
  TriMesh& mesh = simplified.meshes[0].surface;
  mesh.triangles.clear();
  mesh.face_part.clear();
  for (AttributeLayer& layer : mesh.layers) layer.corner_value.clear();
  for (const bool normals : {false, true}) {
    const Shrunk found = rebaked(simplified, rebake_of(original, normals));
    EXPECT_EQ(found.model.images.at(0), original.images[0]);
  }
}

TEST(Rebake, TiledImagesStayAndItIsSaid) {
  Model model = test::textured(test::grid(2, 2), 1);
  for (float& x : model.meshes[0].surface.find(Semantic::uv)->values) x *= 3;
  const Shrunk found = rebaked(model, rebake_of(model));
  EXPECT_EQ(found.model.images, model.images);
  EXPECT_THAT(found.atlases.at(0).not_rebaked_because, testing::HasSubstr("tiled"));
}

TEST(Rebake, CoordinatesThatWentAstrayComeBack) {
  const Model original = test::textured(test::grid(4, 4), 1);
  Model simplified = test::textured(test::grid(1, 1), 1);
  simplified.meshes[0].surface.find(Semantic::uv)->values[0] = -0.05f;
  const Shrunk found = rebaked(simplified, rebake_of(original));
  EXPECT_EQ(found.atlases.at(0).not_rebaked_because, "");
  EXPECT_EQ(found.model.meshes[0].surface.find(Semantic::uv)->values[0], 0);
}

TEST(Rebake, AnotherModelIsRefused) {
  const Squares s = flat_and_wavy(1);
  const Model other = test::textured(test::two_part_grid(2, 1), 1);
  test::expect_error([&] { rebaked(s.simplified, rebake_of(other)); }, ErrorKind::usage, "");
}

TEST(Rebake, CanBeCancelled) {
  const Squares s = flat_and_wavy(1);
  Context context;
  context.cancel();
  test::expect_error([&] { shrink_textures(s.simplified, rebake_of(s.original), {}, context); },
                     ErrorKind::cancelled, "");
}

}  // namespace
}  // namespace fovea
