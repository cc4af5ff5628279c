#include "fovea/io/assimp_read.h"

#include <gtest/gtest.h>

#include "fovea/io/child_process.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::bytes_of;
using test::expect_error;
using test::TempFolder;
using test::told;

/// A quad, textured, in a node that moves it and one that is skinned: Collada, since it can be read.
std::string collada() {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><up_axis>Y_UP</up_axis></asset>
 <library_images><image id="img"><init_from>paint.png</init_from></image></library_images>
 <library_effects><effect id="fx"><profile_COMMON>
  <newparam sid="surf"><surface type="2D"><init_from>img</init_from></surface></newparam>
  <newparam sid="samp"><sampler2D><source>surf</source></sampler2D></newparam>
  <technique sid="t"><phong><diffuse><texture texture="samp" texcoord="UV"/></diffuse></phong></technique>
 </profile_COMMON></effect></library_effects>
 <library_materials><material id="mat" name="painted"><instance_effect url="#fx"/></material></library_materials>
 <library_geometries><geometry id="quad"><mesh>
  <source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
   <technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
  <source id="t"><float_array id="ta" count="8">0 0 1 0 1 1 0 1</float_array>
   <technique_common><accessor source="#ta" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <polylist count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#t" offset="1" set="0"/>
   <vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s">
  <node id="outer" name="outer"><translate>5 0 0</translate>
   <node id="inner" name="inner"><scale>2 2 2</scale>
    <instance_geometry url="#quad"><bind_material><technique_common><instance_material symbol="m" target="#mat"/></technique_common></bind_material></instance_geometry>
   </node></node>
 </visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";
}

TEST(AssimpRead, NodesMaterialsAndImages) {
  TempFolder folder;
  folder.add("paint.png", test::tiny_png());
  const auto path = folder.add("quad.dae", collada());
  Context context;
  const Model model = read_model(path, {}, context);
  ASSERT_EQ(model.meshes.size(), 1u);
  const TriMesh& mesh = model.meshes[0].surface;
  check(mesh);
  EXPECT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(mesh.vertex_count(), 4u);
  const Box box = bounds(model);
  EXPECT_EQ(box.low, (Vec3d{5, 0, 0}));
  EXPECT_EQ(box.high, (Vec3d{7, 2, 0}));
  // Texture coordinates count from the top left: v = 0 of the file is 1.
  const AttributeLayer* uv = mesh.find(Semantic::uv);
  ASSERT_TRUE(uv);
  for (std::size_t c = 0; c < 6; ++c) {
    const Vec3f p = mesh.positions[mesh.vertex(CornerId{c}).index()];
    EXPECT_EQ(uv->value(uv->corner_value[c])[1], 1 - p.y);
  }
  ASSERT_EQ(model.images.size(), 1u);
  EXPECT_EQ(model.images[0].uri, "paint.png");
  EXPECT_TRUE(model.materials.at(static_cast<std::size_t>(mesh.parts[0].material)).base_color);
}

TEST(AssimpRead, ImagesOutsideTheFolderAreNotRead) {
  TempFolder folder;
  folder.add("paint.png", test::tiny_png());
  std::string text = collada();
  text.replace(text.find("paint.png"), 9, "../paint.png");
  const auto path = folder.add("inside/quad.dae", text);
  Context context;
  const Model model = read_model(path, {}, context);
  EXPECT_TRUE(model.images.empty());
  EXPECT_EQ(told(context, "missing-image"), 1u);
}

TEST(AssimpRead, UnknownAndDamagedFilesAreToldApart) {
  TempFolder folder;
  Context context;
  const auto unknown = folder.add("a.xyz", "nothing known");
  expect_error([&] { read_model(unknown, {}, context); }, ErrorKind::unsupported, "a.xyz");
  const auto damaged = folder.add("a.fbx", "Kaydara FBX Binary  and no more");
  expect_error([&] { read_model(damaged, {}, context); }, ErrorKind::format, "a.fbx");
  const auto cut = folder.add("a.dae", collada().substr(0, 900));
  expect_error([&] { read_model(cut, {}, context); }, ErrorKind::format, "a.dae");
}

TEST(AssimpRead, SwitchedOffImportersStayOff) {
  TempFolder folder;
  Context context;
  const auto path = folder.add("a.nff", "nff\nversion 2.0\n");
  expect_error([&] { read_model(path, {}, context); }, ErrorKind::unsupported, "a.nff");
}

std::vector<std::byte> in_child(const std::function<std::vector<std::byte>()>& work,
                                ChildLimits limits = {}) {
  Context context;
  return run_in_child(work, limits, "place", context);
}

TEST(ChildProcess, ResultsAndErrorsComeBack) {
  // Larger than a pipe holds at once.
  std::vector<std::byte> large(std::size_t{1} << 20, std::byte{7});
  EXPECT_EQ(in_child([&] { return large; }), large);
  EXPECT_TRUE(in_child([] { return std::vector<std::byte>(); }).empty());
  const auto error = test::error_of([] {
    in_child([]() -> std::vector<std::byte> { throw Error(ErrorKind::limit, "message", "there", "hint"); });
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::limit);
  EXPECT_EQ(error->message(), "message");
  EXPECT_EQ(error->place(), "there");
  EXPECT_EQ(error->hint(), "hint");
}

TEST(ChildProcess, CrashesAreErrors) {
  expect_error([] { in_child([]() -> std::vector<std::byte> { std::abort(); }); }, ErrorKind::format, "place",
               "broke down");
  expect_error([] { in_child([]() -> std::vector<std::byte> { ::_exit(0); }); }, ErrorKind::format, "place");
  expect_error([] { in_child([]() -> std::vector<std::byte> { throw std::runtime_error("words"); }); },
               ErrorKind::format, "place", "words");
}

TEST(ChildProcess, LimitsAndCancelling) {
  ChildLimits small;
  small.result_bytes = 10;
  expect_error([&] { in_child([] { return std::vector<std::byte>(11); }, small); }, ErrorKind::limit,
               "place");
  ChildLimits quick;
  quick.cpu_seconds = 1;
  expect_error(
      [&] {
        in_child(
            []() -> std::vector<std::byte> {
              for (volatile bool go = true; go;) {
              }
              return {};
            },
            quick);
      },
      ErrorKind::limit, "place", "too long");
  Context context;
  context.progress = [](std::string_view, double) { return false; };
  expect_error(
      [&] {
        run_in_child(
            []() -> std::vector<std::byte> {
              ::sleep(60);
              return {};
            },
            {}, "place", context);
      },
      ErrorKind::cancelled, "");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they have an allocator of their own
TEST(ChildProcess, MemoryIsLimited) {
  ChildLimits small;
  small.memory_bytes = std::uint64_t{64} << 20;
  expect_error([&] { in_child([] { return std::vector<std::byte>(std::size_t{1} << 30); }, small); },
               ErrorKind::limit, "place", "memory");
}
#endif

}  // namespace
}  // namespace fovea
