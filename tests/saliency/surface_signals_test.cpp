#include "fovea/saliency/surface_signals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/base/srgb.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/read.h"
#include "fovea/sample/sample.h"
#include "fovea/surface/neighborhood.h"
#include "oracle/texture_oracle.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/reading.h"

namespace fovea {
namespace {

SurfaceSignals signals(const Model& model, const SurfaceSignalOptions& options = {}, int threads = 1) {
  Context context;
  context.threads = threads;
  return surface_signals(model, 0, options, context);
}

/// Adds an image as a texture; its number.
int add_texture(Model& model, const Image8& image, Wrap wrap = Wrap::repeat) {
  EncodedImage encoded;
  encoded.bytes = encode_png(image);
  Sampler sampler;
  sampler.wrap_u = sampler.wrap_v = wrap;
  Texture texture;
  texture.image = static_cast<int>(model.images.size());
  texture.sampler = static_cast<int>(model.samplers.size());
  model.images.push_back(std::move(encoded));
  model.samplers.push_back(sampler);
  model.textures.push_back(texture);
  return static_cast<int>(model.textures.size()) - 1;
}

TextureRef ref_to(int texture) {
  TextureRef ref;
  ref.texture = texture;
  return ref;
}

Image8 plain(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image8 image(width, height, 3, ColorEncoding::srgb);
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    image.pixels[i] = r;
    image.pixels[i + 1] = g;
    image.pixels[i + 2] = b;
  }
  return image;
}

/// Red on the left, blue on the right.
Image8 halves(int width, int height) {
  Image8 image = plain(width, height, 255, 0, 0);
  for (int y = 0; y < height; ++y) {
    for (int x = width / 2; x < width; ++x) {
      image.at(x, y)[0] = 0;
      image.at(x, y)[2] = 255;
    }
  }
  return image;
}

/// The mesh with one material whose base colour is the image; further parts share it.
Model painted(TriMesh mesh, const Image8& image, Wrap wrap = Wrap::repeat) {
  for (Part& part : mesh.parts) part.material = 0;
  Model model = test::model_of(std::move(mesh));
  model.materials[0].base_color = ref_to(add_texture(model, image, wrap));
  return model;
}

/// Gives a mesh vertex colours, one per vertex.
void color_vertices(TriMesh& mesh, const std::vector<Vec3f>& colors) {
  AttributeLayer layer;
  layer.semantic = Semantic::color;
  layer.width = 3;
  for (const Vec3f c : colors) layer.values.insert(layer.values.end(), {c.x, c.y, c.z});
  for (const auto& triangle : mesh.triangles) {
    for (const VertexId v : triangle) layer.corner_value.push_back(ValueId{v.index()});
  }
  mesh.layers.push_back(std::move(layer));
}

void scale_uv(TriMesh& mesh, float by, float offset = 0) {
  for (float& x : mesh.find(Semantic::uv)->values) x = x * by + offset;
}

void expect_near(const VertexField& a, const VertexField& b, double within) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t v = 0; v < a.size(); ++v) EXPECT_NEAR(a.values()[v], b.values()[v], within) << v;
}

void expect_all(const VertexField& field, double value, double within = 1e-6) {
  for (const float x : field.values()) EXPECT_NEAR(x, value, within);
}

void expect_equal(const SurfaceSignals& a, const SurfaceSignals& b) {
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.opponency, b.opponency);
  EXPECT_EQ(a.entropy, b.entropy);
  EXPECT_EQ(a.emission, b.emission);
  EXPECT_EQ(a.roughness, b.roughness);
  EXPECT_EQ(a.metalness, b.metalness);
  EXPECT_EQ(a.normal_detail, b.normal_detail);
}

TEST(SurfaceSignals, TheTexelsOfOneTriangleByHand) {
  // 4 × 4 texels under the triangle (0 0) (1 0) (0 1): those with x + y < 3 have their centres inside, x + y
  // = 3 lie on its edge.
  const Image8 image = test::pattern(4, 4);
  const TextureSignals texels = texture_signals(image, Sampler{}, {}, Context());
  double inside = 0, edge = 0;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      if (x + y < 3) inside += static_cast<double>(*texels.intensity.at(x, y));
      if (x + y == 3) edge += static_cast<double>(*texels.intensity.at(x, y));
    }
  }
  const VertexField found = signals(painted(test::single_triangle(), image)).intensity;
  const double without = inside / 6, with = (inside + edge) / 10;
  const double got = static_cast<double>(found.values()[0]);
  EXPECT_LT(std::min(std::abs(got - without), std::abs(got - with)), 1e-6);
  expect_all(found, got);
}

TEST(SurfaceSignals, AVertexHasTheMeanByAreaOfItsTriangles) {
  // A texel is a quad's size: every triangle's mean is a signal near its own texels.
  const TriMesh mesh = test::grid(2, 2);
  const Image8 image = test::pattern(64, 64);
  const TextureSignals texels = texture_signals(image, Sampler{}, {}, Context());
  const SurfaceSignals found = signals(painted(mesh, image));
  EXPECT_TRUE(found.textured);
  // The vertex in the middle touches six triangles of equal area: two whole quads and two halves.
  double sum = 0, count = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      // uv = (x, y): quads are cut along x = y; of the others the half beside the middle counts.
      const bool left = x < 32, top = y < 32;
      const double dx = (x % 32) + 0.5, dy = (y % 32) + 0.5;
      const bool near = left == top || (left ? dx > dy : dx < dy);
      if (!near && dx != dy) continue;
      sum += static_cast<double>(*texels.entropy.at(x, y));
      ++count;
    }
  }
  const std::size_t middle = 4;
  ASSERT_EQ(mesh.positions[middle], (Vec3f{0.5f, 0.5f, 0}));
  EXPECT_NEAR(found.entropy.values()[middle], sum / count, 0.03);
}

TEST(SurfaceSignals, OneColorIsNoTexture) {
  const SurfaceSignals found = signals(painted(test::cube(), plain(8, 8, 255, 0, 51)));
  EXPECT_FALSE(found.textured);
  expect_all(found.intensity, 0.4);
  expect_all(found.opponency, 1 + 0.2);
  expect_all(found.entropy, 0);
  EXPECT_TRUE(found.emission.empty() && found.roughness.empty() && found.metalness.empty() &&
              found.normal_detail.empty());
}

TEST(SurfaceSignals, SmallTrianglesLookBetweenTexels) {
  // Triangles far smaller than texels: what they see changes evenly from texel to texel.
  Image8 image = plain(4, 1, 0, 0, 0);
  for (int x = 0; x < 4; ++x) std::fill_n(image.at(x, 0), 3, static_cast<std::uint8_t>(60 * x));
  const VertexField found = signals(painted(test::grid(64, 1), image, Wrap::clamp)).intensity;
  const auto at = [&](int column) {
    return static_cast<double>(found.values()[static_cast<std::size_t>(column)]);
  };
  for (int column = 26; column < 38; ++column)
    EXPECT_NEAR(at(column + 1) - at(column), 60 / 255.0 / 16, 1e-3);
  EXPECT_NEAR(at(32), 90 / 255.0, 1e-2);
}

TEST(SurfaceSignals, OneByOneTexel) {
  const SurfaceSignals found = signals(painted(test::torus(8, 6), plain(1, 1, 0, 255, 0)));
  expect_all(found.intensity, 1.0 / 3);
  expect_all(found.opponency, -1);
  EXPECT_FALSE(found.textured);
}

TEST(SurfaceSignals, ASeamGathersItsCharts) {
  // The cylinder's seam is between the left end (red) and the right end (blue) of the texture.
  const TriMesh mesh = test::open_cylinder(16, 2);
  const VertexField found = signals(painted(mesh, halves(64, 64), Wrap::clamp)).opponency;
  for (std::size_t v = 0; v < found.size(); ++v) {
    const Vec3f p = mesh.positions[v];
    const double at = static_cast<double>(found.values()[v]);
    EXPECT_NEAR(at, 1, 1e-6) << v;  // both colours have an opponency of 1
    if (std::abs(p.y) < 1e-4f && p.x > 0) EXPECT_NEAR(at, 1, 1e-6);
  }
  const Image8 dark = [] {
    Image8 image = plain(64, 64, 255, 255, 255);
    for (int y = 0; y < 64; ++y) std::fill_n(image.at(32, y), 32 * 3, std::uint8_t{0});
    return image;
  }();
  const VertexField light = signals(painted(mesh, dark, Wrap::clamp)).intensity;
  int seam = 0;
  for (std::size_t v = 0; v < light.size(); ++v) {
    const Vec3f p = mesh.positions[v];
    if (std::abs(p.y) > 1e-4f) continue;
    // At either border of white and black there is as much of both around, but for how quads are cut.
    EXPECT_NEAR(light.values()[v], 0.5, 0.2);
    ++seam;
  }
  EXPECT_EQ(seam, 6);
}

TEST(SurfaceSignals, TwoMaterialsMeet) {
  Model model = test::model_of(test::two_part_grid(2, 1));
  model.materials[0].base_color = ref_to(add_texture(model, plain(4, 4, 255, 255, 255)));
  model.materials[1].base_color_factor = {0, 0, 0, 1};
  const SurfaceSignals found = signals(model);
  const std::vector<Vec3f>& positions = model.meshes[0].surface.positions;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const float x = positions[v].x, at = found.intensity.values()[v];
    if (x < 0.4f) EXPECT_EQ(at, 1);
    if (x > 0.6f) EXPECT_EQ(at, 0);
    // Three triangles of equal area.
    if (x == 0.5f) EXPECT_TRUE(std::abs(at - 1.0f / 3) < 1e-6f || std::abs(at - 2.0f / 3) < 1e-6f) << at;
  }
  EXPECT_TRUE(found.textured);
}

TEST(SurfaceSignals, CoordinatesBeyondTheImageWrap) {
  const Image8 image = test::pattern(32, 32);
  TriMesh mesh = test::grid(8, 8);
  const SurfaceSignals inside = signals(painted(mesh, image));
  scale_uv(mesh, 1, 3);
  const SurfaceSignals beside = signals(painted(mesh, image));
  expect_near(inside.intensity, beside.intensity, 1e-6);
  expect_near(inside.entropy, beside.entropy, 1e-6);
  // Beyond a clamped image there is its last texel.
  const SurfaceSignals clamped = signals(painted(mesh, image, Wrap::clamp));
  EXPECT_FALSE(clamped.textured);
  // A mirrored texture begins again as it ended.
  TriMesh turned = test::grid(8, 8);
  scale_uv(turned, -1, 0);
  expect_near(signals(painted(test::grid(8, 8), image, Wrap::mirror)).opponency,
              signals(painted(turned, image, Wrap::mirror)).opponency, 1e-5);
}

TEST(SurfaceSignals, ManyRepeatsAreSampled) {
  // 128 triangles with 100 × 100 repeats each: hundreds of millions of texels.
  const Image8 image = test::pattern(128, 128);
  TriMesh mesh = test::grid(8, 8);
  scale_uv(mesh, 800, 0.3f);
  const SurfaceSignals found = signals(painted(mesh, image));
  const TextureSignals texels = texture_signals(image, Sampler{}, {}, Context());
  double mean = 0;
  for (const float x : texels.intensity.pixels) mean += static_cast<double>(x);
  expect_all(found.intensity, mean / (128 * 128), 2e-3);
}

TEST(SurfaceSignals, EndlessSliversEnd) {
  const Image8 image = test::pattern(64, 64);
  TriMesh mesh = test::grid(40, 40);
  std::vector<float>& uv = mesh.find(Semantic::uv)->values;
  for (std::size_t i = 0; i < uv.size(); i += 2) uv[i + 1] = i % 4 == 0 ? -9e5f : 9e5f;
  const VertexField found = signals(painted(mesh, image)).entropy;
  for (const float x : found.values()) EXPECT_TRUE(x >= 0 && x <= 5);
}

TEST(SurfaceSignals, ATransformMovesTheTexture) {
  const Image8 image = test::pattern(64, 64);
  Model model = painted(test::grid(8, 8), image);
  TextureTransform transform;
  transform.offset = {0.25, 0.5};
  transform.scale = {0.5, 0.75};
  transform.rotation_rad = 0.3;
  model.materials[0].base_color->transform = transform;
  TriMesh mesh = test::grid(8, 8);
  std::vector<float>& uv = mesh.find(Semantic::uv)->values;
  const double c = std::cos(0.3), s = std::sin(0.3);
  for (std::size_t i = 0; i < uv.size(); i += 2) {
    // offset + R (scale · uv), as the extension has it.
    const double u = 0.5 * static_cast<double>(uv[i]), v = 0.75 * static_cast<double>(uv[i + 1]);
    uv[i] = static_cast<float>(0.25 + c * u + s * v);
    uv[i + 1] = static_cast<float>(0.5 - s * u + c * v);
  }
  expect_near(signals(model).intensity, signals(painted(mesh, image)).intensity, 0.01);
}

TEST(SurfaceSignals, TheSetOfCoordinatesThatTheMaterialNames) {
  const Image8 image = test::pattern(64, 64);
  TriMesh mesh = test::grid(6, 6);
  AttributeLayer second = *mesh.find(Semantic::uv);
  second.set = 1;
  mesh.layers.push_back(second);
  scale_uv(mesh, 0);  // set 0
  Model model = painted(mesh, image);
  EXPECT_FALSE(signals(model).textured);
  model.materials[0].base_color->uv_set = 1;
  expect_equal(signals(model), signals(painted(test::grid(6, 6), image)));
  // No such set: the factor alone.
  model.materials[0].base_color->uv_set = 2;
  expect_all(signals(model).intensity, 1);
}

TEST(SurfaceSignals, CoordinatesThatAreNoNumbersAreNoTexture) {
  TriMesh mesh = test::grid(1, 1);
  mesh.find(Semantic::uv)->values[0] = std::numeric_limits<float>::quiet_NaN();
  const VertexField nan = signals(painted(mesh, plain(4, 4, 0, 0, 0))).intensity;
  mesh.find(Semantic::uv)->values[0] = std::numeric_limits<float>::infinity();
  const VertexField infinite = signals(painted(mesh, plain(4, 4, 0, 0, 0))).intensity;
  mesh.find(Semantic::uv)->values[0] = 1e30f;
  EXPECT_EQ(nan, infinite);
  EXPECT_EQ(nan, signals(painted(mesh, plain(4, 4, 0, 0, 0))).intensity);
  for (const float x : nan.values()) EXPECT_TRUE(x >= 0 && x <= 1);
  EXPECT_GT(*std::max_element(nan.values().begin(), nan.values().end()), 0);
}

TEST(SurfaceSignals, WithoutATextureThereIsTheColor) {
  Model model = test::model_of(test::single_triangle());
  expect_all(signals(model).intensity, 1);  // glTF's default material
  EXPECT_FALSE(signals(model).textured);
  model = painted(test::single_triangle(), plain(1, 1, 0, 0, 0));
  model.materials[0].base_color.reset();
  model.materials[0].base_color_factor = {0.5, 0, 0, 1};
  expect_all(signals(model).intensity, 188 / 765.0);
  expect_all(signals(model).opponency, 1);
  EXPECT_TRUE(signals(test::model_of(test::empty_mesh())).intensity.empty());
}

TEST(SurfaceSignals, AnImageThatCannotBeDecodedIsReported) {
  Model model = painted(test::grid(2, 2), plain(4, 4, 9, 9, 9));
  model.images[0].bytes.resize(20);
  model.materials[0].base_color_factor = {0, 1, 0, 1};
  Context context;
  const SurfaceSignals found = surface_signals(model, 0, {}, context);
  EXPECT_EQ(test::told(context, "image-not-shown"), 1u);
  expect_all(found.intensity, 1.0 / 3);
  EXPECT_FALSE(found.textured);
}

TEST(SurfaceSignals, FactorsMultiplyLight) {
  Model model = painted(test::grid(2, 2), plain(4, 4, 255, 255, 255));
  model.materials[0].base_color_factor = {0.5, 0.5, 0.5, 1};
  expect_all(signals(model).intensity, 188 / 255.0);
}

TEST(SurfaceSignals, VertexColorsAreThere) {
  // Without a texture a vertex has its own colour.
  TriMesh mesh = test::grid(3, 3);
  std::vector<Vec3f> colors(mesh.vertex_count(), Vec3f{0, 1, 0});
  colors[5] = {1, 0, 0};
  color_vertices(mesh, colors);
  const SurfaceSignals found = signals(test::model_of(mesh));
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_FLOAT_EQ(found.opponency.values()[v], v == 5 ? 1.0f : -1.0f);
  expect_all(found.entropy, 0);
  EXPECT_TRUE(found.textured);
}

TEST(SurfaceSignals, VertexColorsMultiplyTexels) {
  const Image8 image = plain(16, 16, 255, 128, 0);
  TriMesh mesh = test::grid(3, 3);
  color_vertices(mesh, std::vector<Vec3f>(mesh.vertex_count(), Vec3f{0.5f, 1, 1}));
  const SurfaceSignals tinted = signals(painted(mesh, image));
  expect_all(tinted.intensity, (188 + 128) / 765.0, 1e-3);
  EXPECT_FALSE(tinted.textured);
  // As the same factor on the material, on any image.
  const Image8 pattern = test::pattern(64, 64);
  Model model = painted(test::grid(3, 3), pattern);
  model.materials[0].base_color_factor = {0.5, 1, 1, 1};
  const SurfaceSignals factor = signals(model), vertices = signals(painted(mesh, pattern));
  expect_near(vertices.intensity, factor.intensity, 0.01);
  expect_near(vertices.opponency, factor.opponency, 0.03);
  // White changes nothing.
  TriMesh white = test::grid(3, 3);
  color_vertices(white, std::vector<Vec3f>(white.vertex_count(), Vec3f{1, 1, 1}));
  expect_equal(signals(painted(white, pattern)), signals(painted(test::grid(3, 3), pattern)));
}

TEST(SurfaceSignals, VertexColorsRunOverATriangle) {
  // Black to white over white texels, by 8 bits: the mean of the display values of a ramp of light.
  TriMesh mesh = test::single_triangle();
  color_vertices(mesh, {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}});
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = (i + 0.5) / 1000;
    sum += 2 * (1 - x) * static_cast<double>(linear_to_srgb(static_cast<float>(x))) / 1000;
  }
  expect_all(signals(painted(mesh, plain(200, 200, 255, 255, 255))).intensity, sum, 0.005);
}

TEST(SurfaceSignals, FurtherSignals) {
  SurfaceSignalOptions options;
  options.emission = options.roughness = options.metalness = options.normal_detail = true;
  Model model = painted(test::grid(3, 3), plain(4, 4, 10, 20, 30));
  Material& material = model.materials[0];
  material.emissive = ref_to(add_texture(model, plain(4, 4, 255, 0, 0)));
  material.emissive_factor = {1, 1, 1};
  material.metallic_roughness = ref_to(add_texture(model, plain(4, 4, 0, 51, 204)));
  material.roughness_factor = 0.5;
  material.metallic_factor = 0.25;
  // Bent by 45 degrees along x.
  material.normal = ref_to(add_texture(model, plain(4, 4, 218, 128, 218)));
  const SurfaceSignals found = signals(model, options);
  expect_all(found.emission, 0.30);
  expect_all(found.roughness, 0.1);
  expect_all(found.metalness, 0.2);
  expect_all(found.normal_detail, 1 - std::sqrt(0.5), 1e-3);
  material.emissive_factor = {0.5, 0, 0};
  expect_all(signals(model, options).emission, 0.30 * 188 / 255, 1e-3);
  material.normal_scale = 0;
  expect_all(signals(model, options).normal_detail, 0, 1e-4);
  material.emissive.reset();
  material.metallic_roughness.reset();
  material.normal.reset();
  const SurfaceSignals bare = signals(model, options);
  expect_all(bare.emission, 0.30 * 188 / 255, 1e-3);
  expect_all(bare.roughness, 0.5);
  expect_all(bare.metalness, 0.25);
  expect_all(bare.normal_detail, 0);
  // One of two that share a texture.
  SurfaceSignalOptions metal;
  metal.metalness = true;
  material.metallic_roughness = ref_to(2);
  expect_all(signals(model, metal).metalness, 0.2);
  EXPECT_TRUE(signals(model, metal).roughness.empty());
}

TEST(SurfaceSignals, AllMeshesAreThoseOneByOne) {
  Model model = test::model_of({test::grid(5, 5), test::two_part_grid(4, 3), test::empty_mesh()});
  model.materials.resize(2);
  model.materials[0].base_color = ref_to(add_texture(model, test::pattern(40, 30)));
  model.materials[1].base_color = ref_to(add_texture(model, test::pattern(20, 50)));
  model.meshes[0].surface.parts[0].material = 1;
  Context context;
  const std::vector<SurfaceSignals> all = surface_signals(model, {}, context);
  ASSERT_EQ(all.size(), 3u);
  for (std::size_t i = 0; i < all.size(); ++i) expect_equal(all[i], surface_signals(model, i, {}, context));
}

TEST(SurfaceSignals, AreNumbersOnEveryMesh) {
  SurfaceSignalOptions options;
  options.normal_detail = true;
  for (const test::NamedMesh& named : test::all_families()) {
    Model model = painted(named.mesh, test::pattern(32, 16));
    if (!model.materials.empty()) model.materials[0].normal = model.materials[0].base_color;
    const SurfaceSignals found = signals(model, options);
    for (const VertexField* field :
         {&found.intensity, &found.opponency, &found.entropy, &found.normal_detail}) {
      ASSERT_EQ(field->size(), named.mesh.vertex_count()) << named.name;
      for (const float x : field->values()) EXPECT_TRUE(std::isfinite(x)) << named.name;
    }
  }
}

TEST(SurfaceSignals, DoNotDependOnTheOrder) {
  const TriMesh mesh = test::torus(24, 16);
  const Image8 image = test::pattern(128, 128);
  const TriMesh other = test::shuffled(mesh);
  const VertexField a = signals(painted(mesh, image)).entropy, b = signals(painted(other, image)).entropy;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto same = std::find(other.positions.begin(), other.positions.end(), mesh.positions[v]);
    EXPECT_NEAR(a.values()[v], b.values()[static_cast<std::size_t>(same - other.positions.begin())], 1e-5);
  }
}

TEST(SurfaceSignals, TheSameBitsForAnyNumberOfThreads) {
  TriMesh mesh = test::torus(60, 40);
  std::vector<Vec3f> colors(mesh.vertex_count(), Vec3f{1, 1, 1});
  for (std::size_t v = 0; v < colors.size() / 2; ++v) colors[v] = {0.5f, 0.25f, 1};
  color_vertices(mesh, colors);
  const Model model = painted(mesh, test::pattern(300, 200));
  expect_equal(signals(model, {}, 1), signals(model, {}, 3));
}

/// Rank correlation of averages over neighbourhoods with those of texels that are gathered one by one, of the
/// three signals at radii 2^l times that of a mean triangle, l = 0 … 5. At `samples` of the vertices.
std::vector<std::array<double, 3>> correlations(const Model& model, std::size_t samples) {
  Context context;
  const TriMesh& mesh = model.meshes[0].surface;
  const TextureRef ref = *model.materials[static_cast<std::size_t>(mesh.parts[0].material)].base_color;
  const Texture& texture = model.textures[static_cast<std::size_t>(ref.texture)];
  const Image8 image = decode_image(model.images[static_cast<std::size_t>(texture.image)].bytes);
  const TextureSignals texels = texture_signals(image, Sampler{}, {}, context);
  const test::TexelGather gather(mesh, ref, image.width, image.height);
  const SurfaceSignals signals = surface_signals(model, 0, {}, context);
  const Surface surface = surface_of(mesh);
  const Adjacency adjacency(surface, context);
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3d p = surface.position(a);
    area += length(cross(surface.position(b) - p, surface.position(c) - p)) / 2;
  }
  const double unit =
      std::sqrt(4 * area / static_cast<double>(surface.triangles.size()) / (3 * std::sqrt(3.0)));
  std::vector<double> radii;
  for (int l = 0; l <= 5; ++l) radii.push_back(std::ldexp(unit, l));
  std::vector<std::array<double, 3>> result(radii.size());
  const ImageF* const planes[] = {&texels.intensity, &texels.opponency, &texels.entropy};
  const VertexField* const fields[] = {&signals.intensity, &signals.opponency, &signals.entropy};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<VertexField> averages =
        gaussian_averages(surface, adjacency, *fields[k], radii, 1, DistanceKind::euclidean, context);
    for (std::size_t l = 0; l < radii.size(); ++l) {
      Random random(1);
      std::vector<double> slow, fast;
      for (std::size_t i = 0; i < samples; ++i) {
        const std::uint32_t v = random.below(static_cast<std::uint32_t>(mesh.vertex_count()));
        const std::optional<double> direct = gather.average(*planes[k], v, radii[l]);
        if (!direct) continue;
        slow.push_back(*direct);
        fast.push_back(static_cast<double>(averages[l].values()[v]));
      }
      EXPECT_GT(slow.size(), samples / 2);
      result[l][k] = test::rank_correlation(slow, fast);
    }
  }
  return result;
}

void expect_correlated(const Model& model, std::size_t samples) {
  const std::vector<std::array<double, 3>> found = correlations(model, samples);
  for (std::size_t l = 0; l < found.size(); ++l) {
    std::printf("l = %zu: intensity %.3f, opponency %.3f, entropy %.3f\n", l, found[l][0], found[l][1],
                found[l][2]);
    if (l == 0) continue;  // narrower than what the paper's scales begin with
    for (const double r : found[l]) EXPECT_GE(r, 0.9) << "radius 2^" << l;
  }
}

TEST(InverseMapping, OnASample) {
  Context context;
  expect_correlated(make_sample("vase", 0.4, context), 150);
}

TEST(InverseMapping, OnARealModel) {
  const auto path = test::corpus_file("textured/DamagedHelmet.glb");
  if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
  Context context;
  expect_correlated(read_model(*path, {}, context), 60);
}

}  // namespace
}  // namespace fovea
