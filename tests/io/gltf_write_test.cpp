#include "fovea/io/gltf_write.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "fovea/base/error.h"
#include "io/gltf_written.h"
#include "support/corner_soup.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using nlohmann::json;
using test::Written;

TEST(GltfWrite, EveryMeshFamilyReadsBackTheSame) {
  for (const auto& [name, mesh] : test::all_families()) {
    if (mesh.face_count() == 0) continue;
    const Model model = Written(test::model_of(mesh)).read();
    ASSERT_EQ(model.meshes.size(), 1u) << name;
    EXPECT_TRUE(test::corner_soup(model.meshes[0].surface) == test::corner_soup(mesh)) << name;
  }
}

TEST(GltfWrite, MeshoptReadsBackTheSame) {
  WriteOptions options;
  options.compression = GeometryCompression::meshopt;
  for (const auto& [name, mesh] : test::all_families()) {
    if (mesh.face_count() == 0) continue;
    const Written written(test::model_of(mesh), options);
    EXPECT_TRUE(test::corner_soup(written.read().meshes[0].surface) == test::corner_soup(mesh)) << name;
    EXPECT_TRUE(test::lists(written.json, "extensionsRequired", "EXT_meshopt_compression")) << name;
    EXPECT_TRUE(written.json["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"]) << name;
  }
}

TEST(GltfWrite, ContainerKeepsTheRulesOfGlb) {
  const Written written(test::model_of(test::cube()));
  EXPECT_EQ(written.text(0, 4), "glTF");
  EXPECT_EQ(written.word(4), 2u);
  EXPECT_EQ(written.word(8), written.file.size());
  EXPECT_EQ(written.word(12) % 4, 0u);
  EXPECT_EQ(written.text(16, 4), "JSON");
  const std::size_t bin = 20 + written.word(12);
  EXPECT_EQ(written.word(bin) % 4, 0u);
  EXPECT_EQ(written.text(bin + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(written.json["buffers"][0]["byteLength"], written.word(bin));
  EXPECT_FALSE(written.json["buffers"][0].contains("uri"));
  EXPECT_EQ(written.json["asset"]["version"], "2.0");
  EXPECT_EQ(written.counts.total(), written.file.size());
}

TEST(GltfWrite, ByteCountsAreThoseOfTheViews) {
  Model model = test::skinned_model(4);
  EncodedImage image;
  image.mime_type = "image/png";
  image.bytes.assign(101, 7);
  model.images = {image};
  const Written written(model);
  EXPECT_EQ(written.counts.images, 101u);
  // Two times, two rotations, two matrices.
  EXPECT_EQ(written.counts.animation, 2u * 4 + 2 * 16 + 2 * 64);
  std::uint64_t geometry = 0;
  for (const json& view : written.json["bufferViews"]) {
    if (view.contains("target")) geometry += view["byteLength"].get<std::uint64_t>();
  }
  EXPECT_EQ(written.counts.geometry, geometry);
  EXPECT_EQ(written.counts.total(), written.file.size());
}

TEST(GltfWrite, ModelWithoutAnythingIsStillAFile) {
  const Written written{Model{}};
  EXPECT_TRUE(written.binary.empty());
  for (const char* name : {"buffers", "bufferViews", "accessors", "meshes", "nodes", "extensionsUsed"}) {
    EXPECT_FALSE(written.json.contains(name)) << name;
  }
  EXPECT_TRUE(written.read().meshes.empty());
}

// ---- what was untouched ----

TEST(GltfWrite, UntouchedElementsAreWrittenAsTheyCame) {
  Model model = test::model_of(test::cube());
  const auto element = [](const char* extra) {
    return std::string(R"({"extensions":{"X_unknown":{"deep":[1,{"a":2.5}]}},"extras":{"mine":")") + extra +
           R"("}})";
  };
  model.json = R"({"asset":{"version":"2.0","copyright":"us","generator":"x"},"extras":{"mine":"root"}})";
  model.nodes[0].json = element("node");
  model.meshes[0].json = element("mesh");
  model.meshes[0].surface.parts[0].json = element("primitive");
  model.materials.resize(1);
  model.materials[0].json = element("material");
  model.scenes[0].json = element("scene");
  model.extensions_used = {"X_unknown"};
  const Written written(model);
  const auto expect_kept = [&](const json& object, const char* extra) {
    EXPECT_EQ(object["extras"]["mine"], extra);
    EXPECT_EQ(object["extensions"]["X_unknown"]["deep"][1]["a"], 2.5) << extra;
  };
  expect_kept(written.json["nodes"][0], "node");
  expect_kept(written.json["meshes"][0], "mesh");
  expect_kept(written.primitive(), "primitive");
  expect_kept(written.json["materials"][0], "material");
  expect_kept(written.json["scenes"][0], "scene");
  EXPECT_EQ(written.json["extras"]["mine"], "root");
  EXPECT_EQ(written.json["asset"]["copyright"], "us");
  EXPECT_EQ(written.json["extensionsUsed"], json({"X_unknown"}));
}

TEST(GltfWrite, WrittenDefaultsStayAndChangedMembersChange) {
  Material material;
  material.json = R"({"name":"old","alphaMode":"OPAQUE","alphaCutoff":0.3,"doubleSided":true,
                      "pbrMetallicRoughness":{"metallicFactor":1.0,"roughnessFactor":0.25,"extras":5}})";
  material.name = "new";
  material.metallic_factor = 1;
  material.roughness_factor = 0.5;
  material.double_sided = false;
  Model model;
  model.materials = {material};
  const json written = Written(model).json["materials"][0];
  EXPECT_EQ(written, json::parse(R"({"name":"new","alphaMode":"OPAQUE","alphaCutoff":0.3,
                      "pbrMetallicRoughness":{"metallicFactor":1.0,"roughnessFactor":0.5,"extras":5}})"));
}

TEST(GltfWrite, MaterialsMadeInMemoryReadBackTheSame) {
  Model model = test::model_of(test::cube());
  model.images.resize(1);
  model.images[0].mime_type = "image/png";
  model.images[0].bytes = {1, 2, 3};
  model.samplers.resize(1);
  model.samplers[0].wrap_u = Wrap::mirror;
  model.samplers[0].min_filter = 9987;
  Texture texture;
  texture.image = texture.sampler = 0;
  model.textures = {texture};
  Material m;
  m.name = "all";
  m.base_color_factor = {0.1, 0.2, 0.3, 0.4};
  m.base_color = TextureRef{0, 1, TextureTransform{{0.5, 0.25}, 1.5, {2, 3}}};
  m.metallic_factor = 0.2;
  m.roughness_factor = 0.7;
  m.metallic_roughness = TextureRef{0, 0, {}};
  m.normal = TextureRef{0, 0, {}};
  m.normal_scale = 0.5;
  m.occlusion = TextureRef{0, 1, {}};
  m.occlusion_strength = 0.75;
  m.emissive = TextureRef{0, 0, {}};
  m.emissive_factor = {1, 0.5, 0.25};
  m.alpha_mode = AlphaMode::mask;
  m.alpha_cutoff = 0.4;
  m.double_sided = m.unlit = true;
  model.materials = {m};
  const Written written(model);
  const Material r = written.read().materials.at(0);
  EXPECT_EQ(r.name, m.name);
  EXPECT_EQ(r.base_color_factor, m.base_color_factor);
  EXPECT_EQ(r.base_color, m.base_color);
  EXPECT_EQ(r.metallic_factor, m.metallic_factor);
  EXPECT_EQ(r.roughness_factor, m.roughness_factor);
  EXPECT_EQ(r.metallic_roughness, m.metallic_roughness);
  EXPECT_EQ(r.normal, m.normal);
  EXPECT_EQ(r.normal_scale, m.normal_scale);
  EXPECT_EQ(r.occlusion, m.occlusion);
  EXPECT_EQ(r.occlusion_strength, m.occlusion_strength);
  EXPECT_EQ(r.emissive, m.emissive);
  EXPECT_EQ(r.emissive_factor, m.emissive_factor);
  EXPECT_EQ(r.alpha_mode, m.alpha_mode);
  EXPECT_EQ(r.alpha_cutoff, m.alpha_cutoff);
  EXPECT_TRUE(r.double_sided);
  EXPECT_TRUE(r.unlit);
  EXPECT_EQ(written.read().samplers.at(0).wrap_u, Wrap::mirror);
  EXPECT_EQ(written.read().samplers.at(0).min_filter, 9987);
  EXPECT_EQ(written.json["extensionsUsed"], json({"KHR_materials_unlit", "KHR_texture_transform"}));
}

TEST(GltfWrite, UvSetOfATransformWins) {
  Material m;
  m.json =
      R"({"normalTexture":{"index":0,"texCoord":0,"extensions":{"KHR_texture_transform":{"texCoord":1}}}})";
  m.normal = TextureRef{0, 1, TextureTransform{}};
  Model model;
  model.materials = {m};
  EXPECT_EQ(Written(model).json["materials"][0], json::parse(m.json));
  model.materials[0].normal->uv_set = 2;
  const json changed = Written(model).json["materials"][0]["normalTexture"];
  EXPECT_EQ(changed["texCoord"], 2);
  EXPECT_FALSE(changed["extensions"]["KHR_texture_transform"].contains("texCoord"));
}

TEST(GltfWrite, NodesCamerasAndAnimationsReadBackTheSame) {
  Model model = test::skinned_model(4);
  Camera camera;
  camera.name = "eye";
  camera.aspect = 1.5;
  Camera flat;
  flat.perspective = false;
  flat.xmag = 3;
  flat.zfar = 10;
  model.cameras = {camera, flat};
  model.nodes[1].camera = 0;
  model.nodes[1].rotation = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};
  model.nodes[1].scale = {1, 2, 3};
  model.nodes[0].matrix = compose({1, 2, 3}, Quat{}, {2, 2, 2});
  model.nodes[0].name = "strip";
  const Model read = Written(model).read();
  ASSERT_EQ(read.nodes.size(), model.nodes.size());
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    EXPECT_EQ(read.nodes[n].local(), model.nodes[n].local());
    EXPECT_EQ(read.nodes[n].children, model.nodes[n].children);
    EXPECT_EQ(read.nodes[n].mesh, model.nodes[n].mesh);
    EXPECT_EQ(read.nodes[n].skin, model.nodes[n].skin);
    EXPECT_EQ(read.nodes[n].camera, model.nodes[n].camera);
    EXPECT_EQ(read.nodes[n].name, model.nodes[n].name);
  }
  EXPECT_EQ(read.cameras[0].aspect, camera.aspect);
  EXPECT_EQ(read.cameras[0].yfov_rad, camera.yfov_rad);
  EXPECT_FALSE(read.cameras[1].perspective);
  EXPECT_EQ(read.cameras[1].xmag, 3);
  EXPECT_EQ(read.cameras[1].zfar, 10);
  EXPECT_EQ(read.skins[0].joints, model.skins[0].joints);
  EXPECT_EQ(read.skins[0].inverse_bind, model.skins[0].inverse_bind);
  ASSERT_EQ(read.animations.size(), 1u);
  EXPECT_EQ(read.animations[0].name, "bend");
  EXPECT_EQ(read.animations[0].channels[0].path, "rotation");
  EXPECT_EQ(read.animations[0].channels[0].node, 2);
  EXPECT_EQ(read.animations[0].samplers[0].input, model.animations[0].samplers[0].input);
  EXPECT_EQ(read.animations[0].samplers[0].output, model.animations[0].samplers[0].output);
  EXPECT_EQ(read.default_scene, 0);
}

TEST(GltfWrite, CarriedDataKeepsItsIndices) {
  Model model = test::model_of(test::cube());
  model.carried_buffer_views = {{std::byte{1}}, {std::byte{1}}};  // equal, but two indices rely on them
  model.carried_accessors = {Accessor::from_floats({1, 2, 3}, 3), Accessor::from_floats({1, 2, 3}, 3)};
  model.json = R"({"extensions":{"X_data":{"bufferView":1,"accessor":1}}})";
  const Written written(model);
  EXPECT_EQ(written.raw<float>(0), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(written.raw<float>(1), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(written.json["bufferViews"][0]["byteLength"], 1);
  EXPECT_EQ(written.json["bufferViews"][1]["byteLength"], 1);
  const Model read = written.read();
  EXPECT_EQ(read.carried_buffer_views.size(), 1u);  // only one is referred to
  EXPECT_EQ(read.carried_accessors.at(0), model.carried_accessors[1]);
}

TEST(GltfWrite, InstancesReadBackAndStayWhereTheyWere) {
  Model model = test::model_of(test::cube());
  const double half = std::sqrt(0.5);
  model.nodes[0].instances = {compose({1, 2, 3}, {0, half, 0, half}, {1, 1, 1}),
                              compose({0, 0, 0}, {half, 0, 0, -half}, {1, 2, 4}),
                              compose({0, 0, 9}, {}, {-1, 1, 1})};
  const Written written(model);
  const Model read = written.read();
  ASSERT_EQ(read.nodes[0].instances.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 16; ++k) {
      // Rotations and scales go through floats, with rounding of 6e-8 of numbers up to 4.
      EXPECT_NEAR(read.nodes[0].instances[i].m[k], model.nodes[0].instances[i].m[k], 2e-6) << i << " " << k;
    }
  }
  const Written again(read);
  EXPECT_EQ(again.json["nodes"][0], json::parse(read.nodes[0].json));
  EXPECT_TRUE(test::lists(again.json, "extensionsUsed", "EXT_mesh_gpu_instancing"));
}

TEST(GltfWrite, PointsAndLinesPassThrough) {
  Model model = test::model_of(test::cube());
  Part lines;
  lines.raw.emplace();
  lines.raw->mode = 1;
  lines.raw->attributes = {
      {"POSITION", Accessor::from_floats({0, 0, 0, 1, 2, -3}, 3)},
      {"COLOR_0", Accessor::from_floats({1, 0, 0, 0, 1, 0}, 3, {ComponentType::u8, true})}};
  lines.raw->indices = Accessor::from_floats({0, 1}, 1, {ComponentType::u8, false});
  model.meshes[0].surface.parts.push_back(lines);
  const Written written(model);
  EXPECT_EQ(written.primitive(0, 1)["mode"], 1);
  EXPECT_EQ(written.accessor(written.primitive(0, 1)["attributes"]["POSITION"])["max"], json({1, 2, 0}));
  const Model read = written.read();
  const auto& raw = read.meshes[0].surface.parts.at(1).raw;
  ASSERT_TRUE(raw.has_value());
  EXPECT_EQ(raw->indices, lines.raw->indices);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(raw->attributes[i].name, lines.raw->attributes[i].name);
    EXPECT_EQ(raw->attributes[i].data, lines.raw->attributes[i].data);
  }
}

// ---- extension lists ----

TEST(GltfWrite, ExtensionListsSayWhatTheFileUses) {
  Model model = test::model_of(test::cube());
  model.extensions_used = {"KHR_mesh_quantization", "KHR_draco_mesh_compression", "KHR_texture_transform",
                           "X_kept"};
  model.extensions_required = {"KHR_mesh_quantization", "KHR_draco_mesh_compression", "X_kept"};
  const Written written(model);
  EXPECT_EQ(written.json["extensionsUsed"], json({"X_kept"}));
  EXPECT_EQ(written.json["extensionsRequired"], json({"X_kept"}));

  model.nodes[0].json = R"({"extensions":{"X_found":{}},"extras":{"extensions":{"X_not_ours":{}}}})";
  EXPECT_EQ(Written(model).json["extensionsUsed"], json({"X_kept", "X_found"}));
}

// ---- meshes without triangles ----

TEST(GltfWrite, EmptyMeshesAreLeftOutWithWhatNeedsThem) {
  Model model = test::model_of({test::cube(), test::morph_strip(2), test::tetrahedron()});
  TriMesh& gone = model.meshes[1].surface;
  gone.triangles.clear();
  gone.face_part.clear();
  for (AttributeLayer& layer : gone.layers) layer.corner_value.clear();
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats({0, 1}, 1);
  sampler.output = Accessor::from_floats({0, 1, 1, 0}, 1);
  Animation lost, kept;
  lost.samplers = kept.samplers = {sampler};
  lost.channels = {{0, 1, "weights", {}}};
  kept.channels = {
      {0, 1, "weights", {}},
      {0, -1, "pointer",
       R"({"target":{"extensions":{"KHR_animation_pointer":{"pointer":"/meshes/2/weights"}}}})"},
      {0, -1, "pointer",
       R"({"target":{"extensions":{"KHR_animation_pointer":{"pointer":"/meshes/1/weights"}}}})"}};
  model.animations = {lost, kept};
  const Written written(model);
  ASSERT_EQ(written.json["meshes"].size(), 2u);
  EXPECT_EQ(written.json["nodes"][0]["mesh"], 0);
  EXPECT_FALSE(written.json["nodes"][1].contains("mesh"));
  EXPECT_FALSE(written.json["nodes"][1].contains("weights"));
  EXPECT_EQ(written.json["nodes"][2]["mesh"], 1);
  ASSERT_EQ(written.json["animations"].size(), 1u);
  ASSERT_EQ(written.json["animations"][0]["channels"].size(), 1u);
  EXPECT_EQ(written.json["animations"][0]["channels"][0]["target"]["extensions"]["KHR_animation_pointer"]
                        ["pointer"],
            "/meshes/1/weights");
  EXPECT_EQ(written.told("empty-mesh"), 1u);
  EXPECT_EQ(written.told("empty-channel"), 3u);
  EXPECT_EQ(written.told("empty-animation"), 1u);
}

TEST(GltfWrite, EmptyPartsAreLeftOut) {
  TriMesh mesh = test::two_part_grid(4, 2);
  TriMesh left = mesh;
  left.triangles.clear();
  left.face_part.clear();
  for (AttributeLayer& layer : left.layers) layer.corner_value.clear();
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_part[f] != 1) continue;
    left.triangles.push_back(mesh.triangles[f]);
    left.face_part.push_back(1);
    for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
      for (std::size_t k = 0; k < 3; ++k) {
        left.layers[l].corner_value.push_back(mesh.layers[l].corner_value[3 * f + k]);
      }
    }
  }
  const Written written(test::model_of(left));
  ASSERT_EQ(written.json["meshes"][0]["primitives"].size(), 1u);
  EXPECT_EQ(written.primitive()["material"], 1);
  EXPECT_EQ(written.told("empty-part"), 1u);
}

// ---- how geometry is stored ----

TEST(GltfWrite, EqualMeshesAreStoredOnce) {
  const Written one(test::model_of({test::cube()}));
  for (const GeometryCompression compression : {GeometryCompression::none, GeometryCompression::meshopt}) {
    WriteOptions options;
    options.compression = compression;
    const Written single(test::model_of({test::cube()}), options);
    const Written three(test::model_of({test::cube(), test::cube(), test::cube()}), options);
    EXPECT_EQ(three.json["meshes"].size(), 3u);
    EXPECT_EQ(three.json["accessors"], single.json["accessors"]);
    EXPECT_EQ(three.json["bufferViews"], single.json["bufferViews"]);
    EXPECT_EQ(three.counts.geometry, single.counts.geometry);
  }
}

TEST(GltfWrite, IndicesAreAsSmallAsGpusLikeThem) {
  EXPECT_EQ(Written(test::model_of(test::cube())).json["accessors"].back()["componentType"],
            5123);                                            // never bytes
  const Written small(test::model_of(test::grid(254, 256)));  // 255 · 257 = 65535 vertices
  EXPECT_EQ(small.accessor(small.primitive()["attributes"]["POSITION"])["count"], 65535);
  EXPECT_EQ(small.accessor(small.primitive()["indices"])["componentType"], 5123);
  const Written large(test::model_of(test::grid(255, 255)));  // 65536 vertices
  EXPECT_EQ(large.accessor(large.primitive()["indices"])["componentType"], 5125);
}

TEST(GltfWrite, AttributesShareOneAlignedView) {
  const Written written(test::model_of(test::cube()));
  std::set<int> views;
  for (const auto& [name, index] : written.primitive()["attributes"].items()) {
    const json& accessor = written.accessor(index);
    views.insert(accessor["bufferView"].get<int>());
    EXPECT_EQ(accessor.value("byteOffset", 0) % 4, 0) << name;
    EXPECT_EQ(written.view_of(accessor)["target"], 34962) << name;
    EXPECT_EQ(written.view_of(accessor)["byteStride"].get<int>() % 4, 0) << name;
  }
  EXPECT_EQ(views.size(), 1u);
  EXPECT_EQ(written.view_of(written.accessor(written.primitive()["indices"]))["target"], 34963);
}

TEST(GltfWrite, ManyAttributesKeepTheLimitOnStrides) {
  test::PartBuilder builder;
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}}) builder.vertex(p);
  builder.triangle(0, 1, 2);
  for (int i = 0; i < 40; ++i) {
    VertexArray array;
    array.name = "_A" + std::to_string(i);
    array.width = 4;
    for (int k = 0; k < 12; ++k) array.values.push_back(static_cast<float>(i + k));
    builder.part().attributes.push_back(array);
  }
  const TriMesh mesh = test::weld_part(builder.part());
  const Written written(test::model_of(mesh));
  for (const json& view : written.json["bufferViews"]) EXPECT_LE(view.value("byteStride", 4), 252);
  EXPECT_TRUE(test::corner_soup(written.read().meshes[0].surface) == test::corner_soup(mesh));
}

TEST(GltfWrite, CustomAttributesGetTheirUnderscoreAndImpossibleOnesAreTold) {
  test::PartBuilder builder;
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}}) builder.vertex(p);
  builder.triangle(0, 1, 2);
  for (const auto& [name, width] : std::map<std::string, int>{{"quality", 1}, {"odd", 7}}) {
    VertexArray array;
    array.name = name;
    array.width = width;
    array.values.assign(static_cast<std::size_t>(3 * width), 0.5f);
    builder.part().attributes.push_back(array);
  }
  const Written written(test::model_of(test::weld_part(builder.part())));
  EXPECT_TRUE(written.primitive()["attributes"].contains("_quality"));
  EXPECT_EQ(written.primitive()["attributes"].size(), 3u);  // with POSITION and TEXCOORD_0
  EXPECT_EQ(written.told("attribute-dropped"), 1u);
}

TEST(GltfWrite, BoundsAreThoseOfTheStoredNumbers) {
  for (const bool quantize : {false, true}) {
    WriteOptions options;
    options.quantize = quantize;
    const Written written(test::model_of(test::wavy_grid(7, 5, 0.3)), options);
    const json position = written.primitive()["attributes"]["POSITION"];
    std::vector<double> values;
    if (quantize) {
      for (const std::uint16_t v : written.raw<std::uint16_t>(position)) values.push_back(v);
    } else {
      for (const float v : written.raw<float>(position)) values.push_back(static_cast<double>(v));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      double low = values[k], high = values[k];
      for (std::size_t i = k; i < values.size(); i += 3) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      EXPECT_EQ(written.accessor(position)["min"][k], low);
      EXPECT_EQ(written.accessor(position)["max"][k], high);
    }
  }
}

TEST(GltfWrite, TargetsHaveAllTheSameAttributesAndZerosCostNothing) {
  const Written written(test::model_of(test::morph_strip(4)));
  const json& targets = written.primitive()["targets"];
  ASSERT_EQ(targets.size(), 2u);
  std::set<std::string> names[2];
  for (std::size_t t = 0; t < 2; ++t) {
    for (const auto& [name, index] : targets[t].items()) names[t].insert(name);
  }
  EXPECT_EQ(names[0], names[1]);
  EXPECT_TRUE(written.accessor(targets[0]["POSITION"]).contains("bufferView"));
  // The second target moves nothing but uv.
  EXPECT_FALSE(written.accessor(targets[1]["POSITION"]).contains("bufferView"));
  EXPECT_EQ(written.accessor(targets[1]["POSITION"])["max"], json({0, 0, 0}));
  EXPECT_TRUE(written.accessor(targets[1]["TEXCOORD_0"]).contains("bufferView"));
}

TEST(GltfWrite, TargetsThatMoveLittleAreStoredSparse) {
  TriMesh mesh = test::grid(20, 20);
  mesh.position_morphs.resize(2, std::vector<Vec3f>(mesh.vertex_count()));
  mesh.position_morphs[0][7] = {0, 0, 1};
  mesh.position_morphs[0][99] = {0, 2, 0};
  for (Vec3f& d : mesh.position_morphs[1]) d = {1, 1, 1};
  const Written written(test::model_of(mesh));
  const json& few = written.accessor(written.primitive()["targets"][0]["POSITION"]);
  EXPECT_EQ(few["sparse"]["count"], 2);
  EXPECT_FALSE(few.contains("bufferView"));
  EXPECT_EQ(few["max"], json({0, 2, 1}));
  EXPECT_FALSE(written.accessor(written.primitive()["targets"][1]["POSITION"]).contains("sparse"));
  EXPECT_TRUE(test::corner_soup(written.read().meshes[0].surface) == test::corner_soup(mesh));
  WriteOptions options;
  options.quantize = true;
  const Written quantized(test::model_of(mesh), options);
  EXPECT_EQ(quantized.accessor(quantized.primitive()["targets"][0]["POSITION"])["sparse"]["count"], 2);
}

TEST(GltfWrite, NumberOfThreadsDoesNotShow) {
  std::vector<TriMesh> meshes;
  for (auto& family : test::all_families()) meshes.push_back(std::move(family.mesh));
  const Model model = test::model_of(std::move(meshes));
  WriteOptions options;
  options.quantize = true;
  options.compression = GeometryCompression::meshopt;
  const Written one(model, options, 1), four(model, options, 4);
  EXPECT_EQ(one.file, four.file);
  const auto told_one = one.context.diagnostics(), told_four = four.context.diagnostics();
  ASSERT_EQ(told_one.size(), told_four.size());
  for (std::size_t i = 0; i < told_one.size(); ++i) {
    EXPECT_EQ(told_one[i].place, told_four[i].place);
    EXPECT_EQ(told_one[i].count, told_four[i].count);
  }
}

TEST(GltfWrite, WrongModelsAreTheCallersFault) {
  const auto expect_usage = [](const Model& model, const char* place) {
    try {
      Written{model};
      ADD_FAILURE() << place;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::usage);
      EXPECT_EQ(e.place(), place);
    }
  };
  Model model = test::model_of(test::cube());
  model.nodes[0].mesh = 1;
  expect_usage(model, "/nodes/0/mesh");
  model = test::skinned_model(2);
  model.animations[0].channels[0].node = 7;
  expect_usage(model, "/animations/0");
  model = test::model_of(test::cube());
  model.nodes[0].json = "[]";
  expect_usage(model, "");
  model.nodes[0].json.clear();
  model.json = R"({"asset":5})";
  expect_usage(model, "");
}

TEST(GltfWrite, CancellingStops) {
  Context context;
  context.cancel();
  try {
    write_gltf(test::model_of(test::cube()), true, "model", {}, context);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::cancelled);
  }
}

}  // namespace
}  // namespace fovea
