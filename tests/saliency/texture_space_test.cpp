#include "fovea/saliency/texture_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/io/image_codec.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::expect_error;

EncodedImage blank(int width, int height) {
  EncodedImage image;
  image.mime_type = "image/png";
  image.bytes = encode_png(Image8(width, height, 1, ColorEncoding::srgb));
  return image;
}

/// The first bytes of a PNG that says it is so large, and no more.
EncodedImage claimed(std::uint32_t width, std::uint32_t height) {
  EncodedImage image = blank(1, 1);
  for (int k = 0; k < 4; ++k) {
    image.bytes[static_cast<std::size_t>(16 + k)] = static_cast<std::uint8_t>(width >> (24 - 8 * k));
    image.bytes[static_cast<std::size_t>(20 + k)] = static_cast<std::uint8_t>(height >> (24 - 8 * k));
  }
  image.bytes.resize(40);
  return image;
}

/// A square of two triangles whose corners lie at these texture coordinates.
SplitPart square(Vec2f low, Vec2f high, int material = 0) {
  test::PartBuilder part(material);
  const std::uint32_t a = part.vertex({0, 0, 0}, low), b = part.vertex({1, 0, 0}, {high.x, low.y}),
                      c = part.vertex({1, 1, 0}, high), d = part.vertex({0, 1, 0}, {low.x, high.y});
  part.quad(a, b, c, d);
  return part.part();
}

Model with_image(const TriMesh& mesh, const EncodedImage& image, const Sampler& sampler = {}) {
  Model model = test::model_of(mesh);
  model.images = {image};
  model.samplers = {sampler};
  model.textures = {{0, 0, "", ""}};
  for (Material& material : model.materials) material.base_color = TextureRef{0, 0, {}};
  return model;
}

/// x at the vertices of the square, so that the field is linear over it.
std::vector<VertexField> field_of_x(const Model& model, float scale = 1) {
  std::vector<VertexField> fields;
  for (const Mesh& mesh : model.meshes) {
    VertexField& field = fields.emplace_back(mesh.surface.vertex_count());
    for (std::size_t v = 0; v < field.size(); ++v) field.values()[v] = scale * mesh.surface.positions[v].x;
  }
  return fields;
}

Image8 drawn(const Model& model, const std::vector<VertexField>& fields, int image = 0) {
  Context context;
  return texture_space_map(model, fields, image, context);
}

TEST(TextureSpace, ATexelHasTheFieldAtItsCentre) {
  // Both the field and its map are linear, so that all that is lost is rounding to 255 levels.
  for (const auto& [width, height] : {std::pair{16, 8}, {7, 13}, {1, 4}}) {
    const Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(width, height));
    const Image8 map = drawn(model, field_of_x(model));
    ASSERT_EQ(map.width, width);
    ASSERT_EQ(map.height, height);
    ASSERT_EQ(map.channels, 1);
    EXPECT_EQ(map.encoding, ColorEncoding::linear);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) EXPECT_NEAR(*map.at(x, y), 255 * (x + 0.5) / width, 0.5 + 1e-4);
    }
  }
}

TEST(TextureSpace, TransformsOfTheTextureCount) {
  // A quarter turn: uv' = (v, 1 − u), so that x runs up the image.
  Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(8, 8));
  TextureTransform turn;
  turn.rotation_rad = std::acos(-1.0) / 2;
  turn.offset = {0, 1};
  model.materials[0].base_color->transform = turn;
  const Image8 map = drawn(model, field_of_x(model));
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(*map.at(x, y), 255 * (7.5 - y) / 8, 0.5 + 1e-4);
  }
}

TEST(TextureSpace, WrapsAsTheSamplerDoes) {
  // u from 1 to 2: repeated it fills the image as 0 to 1 does, mirrored the other way round; clamped it is
  // all in the last column, where the largest counts.
  const auto map_of = [](Wrap wrap) {
    Sampler sampler;
    sampler.wrap_u = wrap;
    const Model model = with_image(test::weld_part(square({1, 0}, {2, 1})), blank(16, 4), sampler);
    return drawn(model, field_of_x(model));
  };
  const Image8 repeated = map_of(Wrap::repeat), mirrored = map_of(Wrap::mirror),
               clamped = map_of(Wrap::clamp);
  for (int x = 0; x < 16; ++x) {
    EXPECT_NEAR(*repeated.at(x, 2), 255 * (x + 0.5) / 16, 0.5 + 1e-4);
    EXPECT_NEAR(*mirrored.at(x, 2), 255 * (15.5 - x) / 16, 0.5 + 1e-4);
  }
  EXPECT_NEAR(*clamped.at(15, 2), 255 * 15.5 / 16, 0.5 + 1e-4);
  EXPECT_EQ(*clamped.at(10, 2), 0) << "five texels away is beyond the gutter of four";
}

TEST(TextureSpace, WhereTrianglesShareTexelsTheLargestCounts) {
  const TriMesh one = test::weld_part(square({0, 0}, {1, 1}));
  Model model = with_image(one, blank(8, 8));
  model.meshes.push_back({"other", one, {}, {}});
  std::vector<VertexField> fields = field_of_x(model);
  for (float& x : fields[1].values()) x = 0.5f;
  for (const bool swapped : {false, true}) {
    if (swapped) std::swap(fields[0], fields[1]);
    const Image8 map = drawn(model, fields);
    for (int x = 0; x < 8; ++x)
      EXPECT_NEAR(*map.at(x, 3), 255 * std::max(0.5, (x + 0.5) / 8), 0.5 + 1e-4) << "in either order";
  }
}

TEST(TextureSpace, MaterialsThatShareAnImageAreDrawnTogether) {
  // Left and right half, each of a material of its own; a third material has an image of its own, and no
  // triangles.
  Model model = with_image(test::weld_parts({square({0, 0}, {0.5f, 1}, 0), square({0.5f, 0}, {1, 1}, 1)}),
                           blank(16, 4));
  model.materials[1].base_color->texture = 1;
  model.textures.push_back({0, -1, "the same image, by another texture", ""});
  model.textures.push_back({1, -1, "", ""});
  model.images.push_back(blank(2, 2));
  model.materials.emplace_back().base_color = TextureRef{2, 0, {}};
  EXPECT_EQ(texture_space_images(model), std::vector<int>{0});
  const Image8 map = drawn(model, field_of_x(model));
  for (int x = 0; x < 16; ++x) EXPECT_NEAR(*map.at(x, 1), 255 * (x % 8 + 0.5) / 8, 0.5 + 1e-4);
}

TEST(TextureSpace, EveryImageHasAMapOfItsOwn) {
  Model model =
      with_image(test::weld_parts({square({0, 0}, {1, 1}, 0), square({0, 0}, {1, 1}, 1)}), blank(4, 4));
  model.images.push_back(blank(8, 2));
  model.textures.push_back({1, 0, "", ""});
  model.materials[0].base_color->texture = 1;
  EXPECT_EQ(texture_space_images(model), (std::vector<int>{0, 1}));
  EXPECT_EQ(drawn(model, field_of_x(model), 0).width, 4);
  EXPECT_EQ(drawn(model, field_of_x(model), 1).width, 8);
}

TEST(TextureSpace, GoesOnForFourTexelsBeyondItsBorder) {
  // A chart from texel 8 to 16 of 32 each way.
  const Model model = with_image(test::weld_part(square({0.25f, 0.25f}, {0.5f, 0.5f})), blank(32, 32));
  std::vector<VertexField> fields = field_of_x(model);
  for (float& x : fields[0].values()) x = 1;
  const Image8 map = drawn(model, fields);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const auto beyond = [](int i) { return i < 8 ? 8 - i : i > 15 ? i - 15 : 0; };
      EXPECT_EQ(*map.at(x, y), beyond(x) + beyond(y) <= 4 ? 255 : 0) << x << " " << y;
    }
  }
}

TEST(TextureSpace, TrianglesBetweenTexelCentresLeaveAMark) {
  Model model = with_image(test::weld_part(square({0.51f, 0.51f}, {0.52f, 0.52f})), blank(4, 4));
  std::vector<VertexField> fields = field_of_x(model);
  for (float& x : fields[0].values()) x = 0.8f;
  EXPECT_NEAR(*drawn(model, fields).at(2, 2), 255 * 0.8, 0.5);
}

TEST(TextureSpace, AnImageOfOneTexelHasTheFieldAtItsCentre) {
  Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(1, 1));
  EXPECT_EQ(drawn(model, field_of_x(model)).pixels.size(), 1u);
  EXPECT_NEAR(drawn(model, field_of_x(model)).pixels[0], 128, 1);
}

TEST(TextureSpace, CoordinatesThatAreNoPlaceAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinite, -infinite, 3e38f}) {
    const Model model =
        with_image(test::weld_parts({square({bad, 0}, {1, 1}), square({0, 0}, {0.5f, 1})}), blank(16, 4));
    const Image8 map = drawn(model, field_of_x(model));
    EXPECT_NEAR(*map.at(4, 1), 255 * 4.5 / 8, 0.5 + 1e-4) << "the sound square is drawn";
    EXPECT_EQ(*map.at(13, 1), 0);
  }
}

TEST(TextureSpace, ValuesBeyondOneAreCut) {
  const Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(8, 1));
  const Image8 high = drawn(model, field_of_x(model, 100)), low = drawn(model, field_of_x(model, -100));
  EXPECT_EQ(*high.at(7, 0), 255);
  EXPECT_EQ(*low.at(7, 0), 0);
  const Image8 none = drawn(model, field_of_x(model, std::numeric_limits<float>::quiet_NaN()));
  for (const std::uint8_t x : none.pixels) EXPECT_EQ(x, 0);
}

TEST(TextureSpace, TilesAreDrawnInBoundedTime) {
  // A texture that repeats 50 000 times each way is drawn as if it did so 16 times: all of it is covered, and
  // its highest value is found.
  for (const float turns : {20.0f, 50000.0f}) {
    const Model model = with_image(test::weld_part(square({0, 0}, {turns, turns})), blank(64, 64));
    const Image8 map = drawn(model, field_of_x(model));
    for (const std::uint8_t x : map.pixels) EXPECT_GT(x, 255 * 15 / 16 - 1) << "one turn of 16 below the end";
  }
}

TEST(TextureSpace, LargeImagesHaveSmallerMaps) {
  // Of 100 000 × 50 000 texels as the header says; nobody has to decode them.
  const Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), claimed(100000, 50000));
  const Image8 map = drawn(model, field_of_x(model));
  EXPECT_EQ(map.width, 4000);
  EXPECT_EQ(map.height, 2000);
  EXPECT_EQ(*map.at(2000, 1000), 128);
}

TEST(TextureSpace, AnImageThatTellsNoSizeIsRefused) {
  Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(8, 8));
  for (const std::size_t size : {0u, 4u, 12u}) {
    model.images[0].bytes.resize(size);
    expect_error([&] { drawn(model, field_of_x(model)); }, ErrorKind::unsupported, "/images/0", "size");
  }
  model.images[0] = claimed(0, 8);
  expect_error([&] { drawn(model, field_of_x(model)); }, ErrorKind::unsupported, "/images/0");
}

TEST(TextureSpace, WithoutATextureThereIsNoSuchSpace) {
  const auto refused = [](const Model& model) {
    expect_error([&] { texture_space_images(model); }, ErrorKind::unsupported, "",
                 "no triangle has a texture");
  };
  refused(Model{});
  refused(test::model_of(test::cube()));
  Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(8, 8));
  EXPECT_EQ(texture_space_images(model), std::vector<int>{0});
  model.materials[0].base_color->uv_set = 1;  // a set that the mesh has not
  refused(model);
  model.materials[0].base_color->uv_set = 0;
  model.textures[0].image = -1;  // what an extension holds
  refused(model);
  model.textures[0].image = 0;
  model.materials[0].emissive = std::exchange(model.materials[0].base_color, std::nullopt);
  refused(model);
}

TEST(TextureSpace, FieldsOfAnotherModelAreRefused) {
  const Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(8, 8));
  expect_error([&] { drawn(model, {}); }, ErrorKind::usage, "");
  expect_error([&] { drawn(model, {VertexField(3)}); }, ErrorKind::usage, "", "3 values");
}

TEST(TextureSpace, CanBeCancelled) {
  const Model model = with_image(test::weld_part(square({0, 0}, {1, 1})), blank(8, 8));
  Context context;
  context.cancel();
  expect_error([&] { texture_space_map(model, field_of_x(model), 0, context); }, ErrorKind::cancelled, "");
}

}  // namespace
}  // namespace fovea
