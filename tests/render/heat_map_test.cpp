#include "fovea/render/heat_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "fovea/base/random.h"
#include "fovea/base/srgb.h"
#include "fovea/io/field_file.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/render/render.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::expect_error;

/// Any numbers from 0 to 1, both ends among them.
std::vector<VertexField> some_fields(const Model& model) {
  Random random(3);
  std::vector<VertexField> fields;
  for (const Mesh& mesh : model.meshes) {
    VertexField& field = fields.emplace_back(mesh.surface.vertex_count());
    for (float& x : field.values()) x = static_cast<float>(random.below(1001)) / 1000;
    if (field.size() > 1) field.values()[0] = 0, field.values()[1] = 1;
  }
  return fields;
}

EncodedImage png(const Image8& image) {
  EncodedImage encoded;
  encoded.mime_type = "image/png";
  encoded.bytes = encode_png(image);
  return encoded;
}

/// A wavy sheet with a picture on it.
Model textured() {
  Model model = test::model_of(test::wavy_grid(6, 6, 0.1));
  model.images = {png(test::pattern(16, 8))};
  model.samplers = {Sampler{}};
  model.textures = {{0, 0, "", ""}};
  model.materials.assign(1, Material{});
  model.materials[0].base_color = TextureRef{0, 0, {}};
  for (Part& part : model.meshes[0].surface.parts) part.material = 0;
  return model;
}

/// The bent arm of two bones with a texture, a tangent and a colour that a heat map has no use for.
Model dressed_skin() {
  Model model = test::skinned_model(6);
  model.images = {png(test::pattern(4, 4))};
  model.textures = {{0, -1, "", ""}};
  model.materials.assign(1, Material{});
  model.materials[0].base_color = TextureRef{0, 0, {}};
  TriMesh& mesh = model.meshes[0].surface;
  for (Part& part : mesh.parts) part.material = 0;
  AttributeLayer color = *mesh.find(Semantic::normal);
  color.semantic = Semantic::color;
  AttributeLayer tangent = color;
  tangent.semantic = Semantic::tangent;
  tangent.width = 4;
  tangent.values.assign(4 * color.size(), 1);
  AttributeLayer custom = color;
  custom.semantic = Semantic::custom;
  custom.name = "_TEMPERATURE";
  mesh.layers.insert(mesh.layers.end(), {color, tangent, custom});
  return model;
}

Model written_and_read(const Model& model, const std::string& name) {
  const test::TempFolder folder;
  Context context;
  write_model(model, folder.path() / name, {}, context);
  return read_model(folder.path() / name, {}, context);
}

float value_at(const TriMesh& mesh, const AttributeLayer& layer, Vec3f position, int component) {
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    if (mesh.positions[mesh.vertex(CornerId{c}).index()] == position)
      return layer.value(layer.corner_value[c])[component];
  }
  return -1;
}

TEST(HeatMap, EveryVertexHasTheColorOfItsNumber) {
  const Model model = textured();
  const auto fields = some_fields(model);
  const Model heat = heat_map(model, fields);
  const TriMesh& mesh = heat.meshes[0].surface;
  check(mesh);
  const AttributeLayer& color = *mesh.find(Semantic::color);
  ASSERT_EQ(color.width, 3);
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    const auto expected = heat_color(fields[0][mesh.vertex(CornerId{c})]);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(to_display(color.value(color.corner_value[c])[k]), expected[k]);
  }
}

TEST(HeatMap, ShowsItsColorsInAnyRenderer) {
  // As base colour it looks as the field does when drawn as heat, but that colours are mixed between vertices
  // rather than numbers. Over 1/40 of the field heat bends by less than a level; rounding twice is another.
  // Where the background shines through they differ more: light is mixed there, and heat is no light.
  const Model model = test::model_of(test::grid(40, 40));
  std::vector<VertexField> fields{VertexField(model.meshes[0].surface.vertex_count())};
  for (std::size_t v = 0; v < fields[0].size(); ++v)
    fields[0].values()[v] = model.meshes[0].surface.positions[v].x;
  const Model heat = heat_map(model, fields);
  Context context;
  RenderOptions options;
  options.width = options.height = 64;
  const auto drawn = [&](const Model& m, Pass pass) {
    options.pass = pass;
    const Pose pose = rest_pose(m);
    const RenderScene scene = make_render_scene(m, pose, context);
    View view;
    view.eye = {0.5, 0.5, 5};
    view.perspective = false;
    view.half_height = 0.6;
    return render(scene, view, options, context, fields);
  };
  const Picture numbers = drawn(model, Pass::field), colors = drawn(heat, Pass::base_color);
  int covered = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (*numbers.coverage.at(x, y) < 255) continue;
      ++covered;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(numbers.color.at(x, y)[c], colors.color.at(x, y)[c], 2);
    }
  }
  EXPECT_GT(covered, 50 * 50);
  EXPECT_EQ(drawn(heat, Pass::field).color.pixels, numbers.color.pixels)
      << "the field can be drawn on either model";
}

TEST(HeatMap, OnlyShapeAndMotionStay) {
  const Model model = dressed_skin();
  const Model heat = heat_map(model, some_fields(model));
  EXPECT_EQ(heat.nodes.size(), model.nodes.size());
  EXPECT_EQ(heat.skins[0].joints, model.skins[0].joints);
  EXPECT_EQ(heat.skins[0].inverse_bind, model.skins[0].inverse_bind);
  ASSERT_EQ(heat.animations.size(), 1u);
  EXPECT_EQ(heat.animations[0].samplers[0].output, model.animations[0].samplers[0].output);
  EXPECT_TRUE(heat.images.empty());
  EXPECT_TRUE(heat.textures.empty());
  EXPECT_TRUE(heat.samplers.empty());

  const TriMesh &mesh = heat.meshes[0].surface, &before = model.meshes[0].surface;
  EXPECT_EQ(mesh.positions, before.positions);
  EXPECT_EQ(mesh.triangles, before.triangles);
  for (const Semantic kept : {Semantic::normal, Semantic::joints, Semantic::weights}) {
    ASSERT_NE(mesh.find(kept), nullptr);
    EXPECT_EQ(mesh.find(kept)->values, before.find(kept)->values);
    EXPECT_EQ(mesh.find(kept)->corner_value, before.find(kept)->corner_value);
  }
  EXPECT_EQ(mesh.layers.size(), 4u) << "the fourth is the colours";

  ASSERT_EQ(heat.materials.size(), 1u);
  EXPECT_EQ(heat.materials[0].metallic_factor, 0);
  EXPECT_EQ(heat.materials[0].roughness_factor, 1);
  EXPECT_FALSE(heat.materials[0].base_color.has_value());
  for (const Part& part : mesh.parts) EXPECT_EQ(part.material, 0);
}

TEST(HeatMap, MorphTargetsStay) {
  const Model model = test::model_of(test::morph_strip(6));
  const Model heat = heat_map(model, some_fields(model));
  EXPECT_EQ(heat.meshes[0].surface.position_morphs, model.meshes[0].surface.position_morphs);
  EXPECT_EQ(heat.meshes[0].surface.find(Semantic::normal)->morphs,
            model.meshes[0].surface.find(Semantic::normal)->morphs);
  check(heat.meshes[0].surface);
}

TEST(HeatMap, BothSidesAreShownIfAnyMaterialShowsThem) {
  Model model = textured();
  EXPECT_FALSE(heat_map(model, some_fields(model)).materials[0].double_sided);
  model.materials.emplace_back().double_sided = true;
  EXPECT_TRUE(heat_map(model, some_fields(model)).materials[0].double_sided);
}

TEST(HeatMap, PointsAndLinesStayWithoutTheirMaterial) {
  Model model = textured();
  Part points;
  points.material = 0;
  points.raw.emplace();
  points.raw->mode = 0;
  points.raw->attributes = {{"POSITION", Accessor::from_floats({0, 0, 0, 1, 1, 1}, 3)}};
  model.meshes[0].surface.parts.push_back(points);
  const Model heat = heat_map(model, some_fields(model));
  const Part& kept = heat.meshes[0].surface.parts.back();
  ASSERT_TRUE(kept.raw.has_value());
  EXPECT_EQ(kept.raw->attributes[0].data, points.raw->attributes[0].data);
  EXPECT_EQ(kept.material, -1) << "heat is the triangles'";
  const Model read = written_and_read(heat, "heat.glb");
  EXPECT_EQ(read.meshes[0].surface.parts.size(), 2u);
}

TEST(HeatMap, GoesThroughAFile) {
  for (const Model& model :
       {textured(), dressed_skin(), test::model_of({test::cube(), test::torus(12, 8)})}) {
    const auto fields = some_fields(model);
    // Files of one kind keep numbers as 16 bits, the other as bytes.
    for (const char* name : {"heat.glb", "heat.ply"}) {
      if (model.meshes.size() > 1 && std::string(name) == "heat.ply") continue;  // one mesh in a PLY
      if (!model.skins.empty() && std::string(name) == "heat.ply") continue;
      const Model read = written_and_read(heat_map(model, fields), name);
      ASSERT_EQ(read.meshes.size(), model.meshes.size()) << name;
      EXPECT_EQ(read.skins.size(), model.skins.size());
      EXPECT_EQ(read.animations.size(), model.animations.size());
      for (std::size_t m = 0; m < model.meshes.size(); ++m) {
        const TriMesh &before = model.meshes[m].surface, &after = read.meshes[m].surface;
        const AttributeLayer* const color = after.find(Semantic::color);
        ASSERT_NE(color, nullptr) << name;
        for (std::size_t v = 0; v < before.vertex_count(); ++v) {
          const auto expected = heat_color(fields[m].values()[v]);
          for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(to_display(value_at(after, *color, before.positions[v], k)),
                      expected[static_cast<std::size_t>(k)])
                << name;
          }
        }
      }
    }
  }
}

TEST(HeatMap, OtherSizesAreRefused) {
  const Model model = test::model_of({test::cube(), test::torus(12, 8)});
  auto fields = some_fields(model);
  const auto refused = [&](const std::vector<VertexField>& f, const std::string& message) {
    expect_error([&] { heat_map(model, f); }, ErrorKind::usage, "", message);
    expect_error([&] { with_attribute(model, f, "_X"); }, ErrorKind::usage, "", message);
  };
  refused({}, "2 meshes");
  refused({fields[0]}, "1 fields");
  refused({fields[1], fields[0]}, "mesh 0");
  fields[1] = VertexField(7);
  refused(fields, "7 values");
}

TEST(HeatMap, AModelOfNothing) {
  EXPECT_TRUE(heat_map(Model{}, {}).meshes.empty());
  EXPECT_EQ(heat_map(test::model_of(test::empty_mesh()), {VertexField()}).meshes.size(), 1u);
}

TEST(WithAttribute, ReadsBackTheSameBits) {
  for (const Model& model :
       {textured(), dressed_skin(), test::model_of({test::cube(), test::torus(12, 8)})}) {
    const auto fields = some_fields(model);
    const Model marked = with_attribute(model, fields, "_SALIENCY");
    for (const Mesh& mesh : marked.meshes) check(mesh.surface);
    EXPECT_EQ(field_from_attribute(marked, "_SALIENCY"), fields);
    const Model read = written_and_read(marked, "marked.glb");
    ASSERT_EQ(read.images.size(), model.images.size());
    for (std::size_t i = 0; i < model.images.size(); ++i)
      EXPECT_EQ(read.images[i].bytes, model.images[i].bytes) << "all else stays";
    const auto found = field_from_attribute(read, "SALIENCY");
    for (std::size_t m = 0; m < model.meshes.size(); ++m) {
      // Writing orders vertices anew.
      const auto sorted = [](const TriMesh& mesh, const VertexField& field) {
        std::vector<std::array<float, 4>> list;
        for (std::size_t v = 0; v < field.size(); ++v) {
          const Vec3f p = mesh.positions[v];
          list.push_back({p.x, p.y, p.z, field.values()[v]});
        }
        std::sort(list.begin(), list.end());
        return list;
      };
      EXPECT_EQ(sorted(read.meshes[m].surface, found[m]), sorted(model.meshes[m].surface, fields[m]));
    }
  }
}

TEST(WithAttribute, ReplacesOneOfThatNameAndNoOther) {
  const Model model = dressed_skin();
  const auto fields = some_fields(model);
  const Model other = with_attribute(model, fields, "_SALIENCY");
  EXPECT_EQ(other.meshes[0].surface.layers.size(), model.meshes[0].surface.layers.size() + 1);
  const Model same = with_attribute(model, fields, "_TEMPERATURE");
  EXPECT_EQ(same.meshes[0].surface.layers.size(), model.meshes[0].surface.layers.size());
  EXPECT_EQ(field_from_attribute(same, "_TEMPERATURE"), fields);
}

// --- Scenes that share images ----------------------------------------------------------------------

std::vector<std::uint8_t> lit_picture(const RenderScene& scene) {
  RenderOptions options;
  options.width = options.height = 48;
  View view;
  view.eye = {0.5, 0.5, 3};
  view.half_height = 0.3;
  return render(scene, view, options, Context()).color.pixels;
}

TEST(SharedImages, AreDecodedOnceAndLookTheSame) {
  // The same image, as in a level of detail: at another number, used by another material.
  const Model first = textured();
  Model second = textured();
  second.images.insert(second.images.begin(), png(test::pattern(8, 8)));
  second.textures[0].image = 1;
  second.textures.push_back({0, 0, "", ""});
  second.materials[0].emissive = TextureRef{1, 0, {}};
  second.materials[0].emissive_factor = {1, 1, 1};
  Context context;
  const RenderScene one = make_render_scene(first, rest_pose(first), context),
                    shared = make_render_scene(second, rest_pose(second), context, &one),
                    alone = make_render_scene(second, rest_pose(second), context);
  ASSERT_EQ(one.images.size(), 1u);
  ASSERT_EQ(shared.images.size(), 2u);
  const auto shares = [&](const SceneImage& image) { return image.map == one.images[0].map; };
  EXPECT_EQ(std::count_if(shared.images.begin(), shared.images.end(), shares), 1);
  EXPECT_EQ(std::count_if(alone.images.begin(), alone.images.end(), shares), 0);
  EXPECT_EQ(lit_picture(shared), lit_picture(alone));
  EXPECT_NE(lit_picture(shared), lit_picture(one)) << "the picture can show the difference";
}

TEST(SharedImages, AnotherEncodingIsAnotherImage) {
  const Model first = textured();
  Model second = textured();
  second.materials[0].occlusion = std::exchange(second.materials[0].base_color, std::nullopt);
  Context context;
  const RenderScene one = make_render_scene(first, rest_pose(first), context),
                    shared = make_render_scene(second, rest_pose(second), context, &one);
  ASSERT_EQ(shared.images.size(), 1u);
  EXPECT_NE(shared.images[0].map, one.images[0].map);
}

TEST(SharedImages, OfOneThatIsDamagedNothingIsShownInEither) {
  Model model = textured();
  model.images[0].bytes.resize(30);
  Context context;
  const RenderScene one = make_render_scene(model, rest_pose(model), context),
                    shared = make_render_scene(model, rest_pose(model), context, &one);
  EXPECT_EQ(shared.images[0].map, one.images[0].map);
  EXPECT_EQ(test::told(context, "image-not-shown"), 1u) << "once, where it was decoded";
  EXPECT_FALSE(shared.materials[0].base_color_texture.has_value());
  EXPECT_EQ(lit_picture(shared), lit_picture(one));
}

TEST(SceneOfAMesh, IsTheMeshInItsOwnSpace) {
  const TriMesh mesh = test::torus(24, 12);
  const RenderScene scene = make_render_scene(mesh);
  EXPECT_EQ(scene.triangle_count, mesh.face_count());
  EXPECT_EQ(scene.meshes[0].surface.positions, mesh.positions);
  EXPECT_EQ(scene.meshes[0].part_material.size(), mesh.parts.size());
  // A torus of radii 1 and 0.4 about the origin: its farthest points are 1.4 away, corners of the box of
  // positions included.
  EXPECT_NEAR(scene.sphere.radius, 1.4, 1e-6);
  // Both sides of its triangles show: what an eye inside of a ball sees is not background.
  const TriMesh ball = test::icosphere(2);
  View view;
  view.eye = {0, 0, 0};
  view.near = 0.01;
  const VisibleSurface seen = visible_surface(make_render_scene(ball), view, 8, 8, Context());
  EXPECT_EQ(std::count(seen.triangle.begin(), seen.triangle.end(), kInvalid), 0);
}

TEST(SceneOfAMesh, AMeshOfNothing) { EXPECT_EQ(make_render_scene(test::empty_mesh()).triangle_count, 0u); }

}  // namespace
}  // namespace fovea
