#include "fovea/render/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/base/srgb.h"
#include "fovea/io/image_codec.h"
#include "fovea/render/shade.h"
#include "support/meshes.h"

namespace fovea {
namespace {

/// A look along −z onto the square [-1, 1]² at z = 0 that fills the picture, in parallel projection.
View flat_view() {
  View view;
  view.eye = {0, 0, 5};
  view.perspective = false;
  view.half_height = 1;
  return view;
}

//   3--2      counter-clockwise seen from +z, uv = (0, 0) at the top left
//   |  |
//   0--1
TriMesh square(double z, int material, double half = 1) {
  test::PartBuilder part(material);
  const auto h = static_cast<float>(half), at = static_cast<float>(z);
  const std::uint32_t a = part.vertex({-h, -h, at}, {0, 1}), b = part.vertex({h, -h, at}, {1, 1}),
                      c = part.vertex({h, h, at}, {1, 0}), d = part.vertex({-h, h, at}, {0, 0});
  part.quad(a, b, c, d);
  return test::weld_part(part.part());
}

Material colored(double r, double g, double b, double a = 1) {
  Material material;
  material.base_color_factor = {r, g, b, a};
  return material;
}

Picture draw(const Model& model, const View& view, RenderOptions options) {
  Context context;
  return render(make_render_scene(model, rest_pose(model), context), view, options, context);
}

RenderOptions flat_options(int size = 16) {
  RenderOptions options;
  options.pass = Pass::base_color;
  options.width = options.height = size;
  return options;
}

std::array<int, 3> pixel(const Picture& picture, int x, int y) {
  const std::uint8_t* p = picture.color.at(x, y);
  return {p[0], p[1], p[2]};
}

TEST(Render, ShowsBaseColorAsItIs) {
  Model model = test::model_of(square(0, 0));
  model.materials = {colored(1, 0.5, 0)};
  const Picture picture = draw(model, flat_view(), flat_options());
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(pixel(picture, x, y), (std::array<int, 3>{255, 188, 0}));
      EXPECT_EQ(*picture.coverage.at(x, y), 255);
    }
  }
}

TEST(Render, EdgesCoverPartOfAPixel) {
  // The square ends a quarter into the twelfth pixel of 16: at 0.53125 of the half-width.
  Model model = test::model_of(square(0, 0, 0.53125));
  model.materials = {colored(1, 1, 1)};
  RenderOptions options = flat_options();
  options.samples = 4;
  const Picture picture = draw(model, flat_view(), options);
  EXPECT_EQ(*picture.coverage.at(8, 8), 255);
  EXPECT_EQ(*picture.coverage.at(12, 8), 64);
  EXPECT_EQ(*picture.coverage.at(13, 8), 0);
  EXPECT_EQ(pixel(picture, 13, 8), (std::array<int, 3>{128, 128, 128}));
  // A quarter of white over grey, mixed as light.
  EXPECT_EQ(pixel(picture, 12, 8)[0], to_display(0.25f + 0.75f * to_light(128)));
}

TEST(Render, BlendedSurfacesAreOrderedByDepthAndNotByFile) {
  const Material red = colored(1, 0, 0),
                 green_glass =
                     [] {
                       Material m = colored(0, 1, 0, 0.5);
                       m.alpha_mode = AlphaMode::blend;
                       return m;
                     }(),
                 blue_glass = [] {
                   Material m = colored(0, 0, 1, 0.25);
                   m.alpha_mode = AlphaMode::blend;
                   return m;
                 }();
  // From back to front: red, green glass, blue glass; then a red sheet behind, which hides nothing.
  const float g = 0.5f * 0.75f, r = 0.5f * 0.75f, b = 0.25f;
  for (const auto& order : {std::array{0, 1, 2}, std::array{2, 1, 0}, std::array{1, 2, 0}}) {
    const TriMesh sheets[] = {square(0, 0), square(1, 1), square(2, 2)};
    Model model = test::model_of({sheets[order[0]], sheets[order[1]], sheets[order[2]]});
    model.materials = {red, green_glass, blue_glass};
    const Picture picture = draw(model, flat_view(), flat_options(4));
    EXPECT_EQ(pixel(picture, 1, 2), (std::array<int, 3>{to_display(r), to_display(g), to_display(b)}));
  }
}

TEST(Render, GlassAloneLetsTheBackgroundThrough) {
  Model model = test::model_of(square(0, 0));
  model.materials = {colored(1, 1, 1, 0.25)};
  model.materials[0].alpha_mode = AlphaMode::blend;
  const Picture picture = draw(model, flat_view(), flat_options(4));
  EXPECT_EQ(*picture.coverage.at(0, 0), 64);
  EXPECT_EQ(pixel(picture, 0, 0)[0], to_display(0.25f + 0.75f * to_light(128)));
}

/// The left half of a texture that is opaque on the left and clear on the right.
Model half_masked() {
  Model model = test::model_of(square(0, 0));
  Image8 image(2, 1, 4, ColorEncoding::srgb);
  image.pixels = {255, 255, 255, 255, 255, 255, 255, 0};
  EncodedImage encoded;
  encoded.bytes = encode_png(image);
  model.images = {encoded};
  Sampler sampler;
  sampler.mag_filter = 9728;
  model.samplers = {sampler};
  Texture texture;
  texture.image = texture.sampler = 0;
  model.textures = {texture};
  Material material;
  material.alpha_mode = AlphaMode::mask;
  material.base_color = TextureRef{0, 0, std::nullopt};
  model.materials = {material};
  return model;
}

TEST(Render, MasksCutHoles) {
  const Picture picture = draw(half_masked(), flat_view(), flat_options());
  EXPECT_EQ(*picture.coverage.at(7, 3), 255);
  EXPECT_EQ(*picture.coverage.at(8, 3), 0);
}

TEST(Render, TextureTransformsTurnTheTexture) {
  Model model = half_masked();
  // Turned by a right angle about the texture's corner and shifted back: the opaque half is below.
  model.materials[0].base_color->transform = TextureTransform{{0, 1}, std::acos(-1.0) / 2, {1, 1}};
  const Picture picture = draw(model, flat_view(), flat_options());
  EXPECT_EQ(*picture.coverage.at(3, 4), 255);
  EXPECT_EQ(*picture.coverage.at(12, 4), 255);
  EXPECT_EQ(*picture.coverage.at(3, 12), 0);
}

TEST(Render, BacksAreSeenOfDoubleSidedSurfacesOnly) {
  View behind = flat_view();
  behind.eye = {0, 0, -5};
  behind.right = {-1, 0, 0};
  behind.back = {0, 0, -1};
  Model model = test::model_of(square(0, 0));
  model.materials = {colored(1, 1, 1)};
  EXPECT_EQ(*draw(model, behind, flat_options()).coverage.at(8, 8), 0);
  model.materials[0].double_sided = true;
  RenderOptions options = flat_options();
  options.pass = Pass::normal;
  const Picture picture = draw(model, behind, options);
  EXPECT_EQ(*picture.coverage.at(8, 8), 255);
  EXPECT_EQ(pixel(picture, 8, 8), (std::array<int, 3>{128, 128, 0})) << "its normal turns to the eye";
}

TEST(Render, AMirroredInstanceShowsItsFront) {
  Model model = test::model_of(square(0, 0));
  model.materials = {colored(1, 1, 1)};
  model.nodes[0].scale = {-1, 1, 1};
  RenderOptions options = flat_options();
  options.pass = Pass::normal;
  const Picture picture = draw(model, flat_view(), options);
  EXPECT_EQ(pixel(picture, 8, 8), (std::array<int, 3>{128, 128, 255}));
}

TEST(Render, AttributesAreInterpolatedInPerspective) {
  // A floor that runs away from the eye: what a pixel sees of it is where its ray meets the plane.
  test::PartBuilder part(0);
  const std::uint32_t a = part.vertex({-50, -1, 1}, {-50, 1}), b = part.vertex({50, -1, 1}, {50, 1}),
                      c = part.vertex({50, -1, -99}, {50, -99}), d = part.vertex({-50, -1, -99}, {-50, -99});
  part.quad(a, b, c, d);
  Model model = test::model_of(test::weld_part(part.part()));
  model.materials = {colored(1, 1, 1)};
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  View view;  // at the origin, looking along −z
  view.half_height = 1;
  view.near = 1e-3;
  const SampleGrid grid{64, 64, 1};
  const Projection projection(view, grid);
  const VisibleSurface seen = visible_surface(scene, view, 64, 64, context);
  int checked = 0;
  for (int y = 33; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint32_t triangle = seen.triangle[static_cast<std::size_t>(y * 64 + x)];
      const Vec2d ray = projection.to_plane(x + 0.5, y + 0.5);
      const double distance = -1 / ray.y;  // to the floor at y = −1
      if (distance > 98) continue;
      ASSERT_NE(triangle, kInvalid);
      ++checked;
      // Corners are rounded to the grid: by 1/512 of a pixel, of the pixels down from the horizon.
      EXPECT_NEAR(seen.distance[static_cast<std::size_t>(y * 64 + x)], distance, distance / 256 / (y - 31.5));
      const TriangleShader shader(scene, projection, 1, triangle);
      const SurfacePoint point = shader.at(x + 0.5, y + 0.5), next = shader.at(x + 1.5, y + 0.5);
      const AttributeLayer& uv = *model.meshes[0].surface.find(Semantic::uv);
      double u = 0, v = 0, slope = 0, moved = 0;
      for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const float* value = uv.value(uv.corner_value[corner(shader.face(), k).index()]);
        u += point.weight[i] * value[0];
        v += point.weight[i] * value[1];
        slope += point.dx[i] * value[0];
        moved += (next.weight[i] - point.weight[i]) * value[0];
      }
      EXPECT_NEAR(u, ray.x * distance, 1e-3 * distance);
      EXPECT_NEAR(v, -distance, 1e-3 * distance);
      EXPECT_NEAR(slope, moved, 2e-3 * distance);  // u is linear along a row of this floor
    }
  }
  EXPECT_GT(checked, 1500);
}

TEST(Render, InsideABoxEveryPixelSeesAWall) {
  // The eye is in a cube of half-width 1: triangles reach behind it and far beyond the picture.
  Model model = test::model_of(test::cube());
  Material material = colored(1, 1, 1);
  material.double_sided = true;
  model.materials = {material};
  for (Part& part : model.meshes[0].surface.parts) part.material = 0;
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  const Box box = bounds(model);
  Random random(9);
  for (int i = 0; i < 20; ++i) {
    const Vec3d direction =
        normalized(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    View view = view_onto({box.center(), 1}, direction, 90, 0);
    view.eye = box.center() +
               Vec3d{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)} *
                   box.diagonal() * 0.5;
    view.near = 1e-4;
    const VisibleSurface seen = visible_surface(scene, view, 40, 40, context);
    const Projection projection(view, {40, 40, 1});
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) {
        const std::size_t at = static_cast<std::size_t>(y * 40 + x);
        const Vec2d plane = projection.to_plane(x + 0.5, y + 0.5);
        const Vec3d ray = view.right * plane.x + view.up * plane.y - view.back;
        double distance = 1e9;  // to the first wall
        const double from[] = {view.eye.x, view.eye.y, view.eye.z}, along[] = {ray.x, ray.y, ray.z};
        const double low[] = {box.low.x, box.low.y, box.low.z}, high[] = {box.high.x, box.high.y, box.high.z};
        for (int k = 0; k < 3; ++k) {
          if (along[k] != 0)
            distance = std::min(distance, ((along[k] > 0 ? high[k] : low[k]) - from[k]) / along[k]);
        }
        ASSERT_NE(seen.triangle[at], kInvalid) << x << " " << y;
        // Clipped corners are rounded to the grid, which tilts walls that run along the ray.
        EXPECT_NEAR(seen.distance[at], distance, 0.02 * distance);
      }
    }
  }
}

TEST(Render, TheSameBitsForAnyNumberOfThreads) {
  Model model = test::model_of({test::torus(64, 32), test::icosphere(3)});
  model.materials = {colored(1, 0.5, 0.25, 0.5)};
  model.materials[0].alpha_mode = AlphaMode::blend;
  for (Part& part : model.meshes[1].surface.parts) part.material = 0;
  Context one, four;
  one.threads = 1;
  four.threads = 4;
  const RenderScene scene = make_render_scene(model, rest_pose(model), one);
  const std::vector<View> views = make_views({}, scene.sphere);
  RenderOptions options;
  options.width = 200;
  options.height = 150;
  const auto a = render_views(scene, views, options, one), b = render_views(scene, views, options, four);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(a[i].color.pixels, b[i].color.pixels);
    EXPECT_EQ(a[i].coverage.pixels, b[i].coverage.pixels);
    EXPECT_EQ(a[i].color.pixels, render(scene, views[i], options, four).color.pixels);
  }
}

TEST(Render, PassesTogetherAreThePassesAlone) {
  Model model = test::model_of({test::torus(32, 16), test::icosphere(2)});
  model.materials = {colored(1, 0.5, 0.25, 0.5), colored(0.2, 0.4, 0.9)};
  model.materials[0].alpha_mode = AlphaMode::blend;
  for (std::size_t m = 0; m < 2; ++m) {
    for (Part& part : model.meshes[m].surface.parts) part.material = static_cast<int>(m);
  }
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  const View view = make_views({}, scene.sphere)[3];
  const Pass passes[] = {Pass::base_color, Pass::lit, Pass::normal, Pass::depth, Pass::part};
  RenderOptions options = flat_options(150);
  const std::vector<Picture> together = render_passes(scene, view, passes, options, context);
  ASSERT_EQ(together.size(), std::size(passes));
  for (std::size_t i = 0; i < std::size(passes); ++i) {
    options.pass = passes[i];
    const Picture alone = render(scene, view, options, context);
    EXPECT_EQ(together[i].color.pixels, alone.color.pixels) << i;
    EXPECT_EQ(together[i].coverage.pixels, alone.coverage.pixels) << i;
  }
}

TEST(Render, OwnCamerasMustBeThere) {
  const Model model = test::model_of(square(0, -1));
  Context context;
  const Pose pose = rest_pose(model);
  const RenderScene scene = make_render_scene(model, pose, context);
  ViewOptions options;
  EXPECT_EQ(views_of(options, model, pose, scene.sphere).size(), 24u);
  options.set = ViewSet::cameras;
  EXPECT_THROW(views_of(options, model, pose, scene.sphere), Error);
}

TEST(Render, ACameraIsAsWideAsItSaysOrAsAScreen) {
  Model model = test::model_of(square(0, -1));
  Camera wide, tall, parallel, odd;
  wide.aspect = 2.5;
  tall.aspect = 1e-9;
  parallel.perspective = odd.perspective = false;
  parallel.xmag = 3, parallel.ymag = 2;
  odd.xmag = odd.ymag = 0;
  model.cameras = {Camera{}, wide, tall, parallel, odd};
  for (int i = 0; i < 5; ++i) {
    Node node;
    node.camera = i;
    model.nodes.push_back(node);
  }
  const std::vector<View> views = camera_views(model, rest_pose(model));
  ASSERT_EQ(views.size(), 5u);
  EXPECT_EQ(picture_width(views[0], 90), 160);
  EXPECT_EQ(picture_width(views[1], 100), 250);
  EXPECT_EQ(picture_width(views[2], 160), 40) << "within reason";
  EXPECT_EQ(picture_width(views[2], 1), 1);
  EXPECT_EQ(picture_width(views[3], 100), 150);
  EXPECT_EQ(picture_width(views[4], 100), 100);
}

TEST(Render, ACameraThatMovesIsAPath) {
  Model model = test::model_of(square(0, -1));
  for (const double x : {0.0, 7.0}) {
    Node node;
    node.camera = static_cast<int>(model.cameras.size());
    node.translation = Vec3d{x, 0, 5};
    model.cameras.emplace_back();
    model.nodes.push_back(node);
  }
  Animation animation;
  animation.samplers.resize(1);
  animation.samplers[0].input = Accessor::from_floats(std::vector<float>{0, 2}, 1);
  animation.samplers[0].output = Accessor::from_floats(std::vector<float>{0, 0, 5, 4, 0, 5}, 3);
  animation.channels = {{0, 1, "translation", {}}};
  model.animations = {animation};
  ViewOptions options;
  options.set = ViewSet::cameras;
  options.count = 5;
  const Sphere sphere;
  const std::vector<View> views = views_of(options, model, rest_pose(model), sphere);
  ASSERT_EQ(views.size(), 6u) << "five along the way, one that stands";
  for (std::size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(views[i].eye.x, static_cast<double>(i));
  EXPECT_EQ(views[1].name, "camera-0-0-0.50s");
  EXPECT_EQ(views[5].name, "camera-1");
  EXPECT_DOUBLE_EQ(views[5].eye.x, 7);
  // At a time of the animation it is where it is then.
  EXPECT_EQ(views_of(options, model, pose_at(model, 0, 1), sphere).size(), 2u);
}

TEST(Render, FieldsAreShownAsHeat) {
  const Model model = test::model_of(square(0, -1));
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  std::vector<float> values;
  for (const Vec3f& p : model.meshes[0].surface.positions) values.push_back(p.x > 0 ? 1.0f : 0.0f);
  RenderOptions options = flat_options(100);
  options.pass = Pass::field;
  const std::vector<VertexField> fields{VertexField(values)};
  const Picture picture = render(scene, flat_view(), options, context, fields);
  for (const int x : {10, 50, 90}) {
    const auto expected = heat_color((static_cast<float>(x) + 0.5f) / 100);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(pixel(picture, x, 50)[k], expected[k], 1);
  }
  EXPECT_THROW(render(scene, flat_view(), options, context, std::vector{VertexField(3)}), Error);
}

TEST(Render, RegionsAreShownByTheirNumbers) {
  // The square's lower corners are region 3, its upper ones region 8; its diagonal runs from corner 0 to 2.
  const Model model = test::model_of(square(0, -1));
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  const TriMesh& mesh = model.meshes[0].surface;
  VertexField numbers(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    numbers.values()[v] = mesh.positions[v].y < 0 ? 3.0f : 8.0f;
  const VertexField fields[] = {numbers};
  RenderOptions options = flat_options();
  options.pass = Pass::region;
  const Picture picture = render(scene, flat_view(), options, context, fields);
  EXPECT_EQ(pixel(picture, 2, 15), pixel(picture, 13, 15));
  EXPECT_EQ(pixel(picture, 2, 0), pixel(picture, 13, 0));
  EXPECT_NE(pixel(picture, 2, 0), pixel(picture, 2, 15));
  EXPECT_NE(pixel(picture, 2, 0), (std::array<int, 3>{128, 128, 128}));
}

TEST(Render, LitSurfacesAreBrighterTowardsTheLight) {
  Model model = test::model_of(test::icosphere(4));
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  RenderOptions options = flat_options(64);
  options.pass = Pass::lit;
  const Picture picture = render(scene, view_onto(scene.sphere, {0, 0, 1}, 30, 0), options, context);
  const int top_right = pixel(picture, 40, 20)[1], bottom_left = pixel(picture, 20, 44)[1];
  EXPECT_GT(top_right, bottom_left + 20);
  EXPECT_GT(bottom_left, 20) << "no side is dark";
}

TEST(Render, ImagesThatCannotBeReadAreReported) {
  Model model = half_masked();
  model.images[0].bytes.resize(20);
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  ASSERT_EQ(context.diagnostics().size(), 1u);
  EXPECT_EQ(context.diagnostics()[0].code, "image-not-shown");
  EXPECT_FALSE(scene.materials[0].base_color_texture.has_value());
}

TEST(Render, NothingGivesTheBackground) {
  const Picture picture = draw(test::model_of(test::empty_mesh()), flat_view(), flat_options());
  EXPECT_EQ(pixel(picture, 3, 3), (std::array<int, 3>{128, 128, 128}));
  EXPECT_THROW(draw(test::model_of(test::empty_mesh()), flat_view(), flat_options(0)), Error);
}

}  // namespace
}  // namespace fovea
