#include "fovea/io/file_bytes.h"

#include <numeric>

#include "support/gltf_builder.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::GltfBuilder;
using test::TempFolder;
using Json = GltfBuilder::Json;

// The triangle of GltfBuilder: three positions and three indices of 16 bits.
constexpr std::uint64_t kTriangle = 36 + 6;

std::uint64_t size_of_all(const std::vector<std::filesystem::path>& files) {
  return std::accumulate(files.begin(), files.end(), std::uint64_t{0}, [](std::uint64_t sum, const auto& f) {
    return sum + std::filesystem::file_size(f);
  });
}

FileBytes measure(const std::filesystem::path& path) {
  Context context;
  return measure_input(path, read_model(path, {}, context));
}

TEST(FileBytes, OfAGlbByKind) {
  GltfBuilder b = GltfBuilder::triangle();
  const int times = b.add_accessor<float>({0, 1}, "SCALAR");
  const int moves = b.add_accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3");
  b.json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", moves}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  const std::string png = test::tiny_png();
  b.json["images"] =
      Json::array({{{"bufferView", b.add_view(test::bytes_of(png))}, {"mimeType", "image/png"}}});
  b.add_view(std::vector<std::byte>(100));  // of no use
  const TempFolder folder;
  const auto path = folder.add("a.glb", test::text_of(b.glb()));
  const FileBytes bytes = measure(path);
  EXPECT_EQ(bytes.format, FileFormat::glb);
  EXPECT_EQ(bytes.files, std::filesystem::file_size(path));
  EXPECT_EQ(bytes.kinds.geometry, kTriangle);
  EXPECT_EQ(bytes.kinds.animation, 8u + 24u);
  EXPECT_EQ(bytes.kinds.images, png.size());
  EXPECT_EQ(bytes.kinds.total(), bytes.files);
}

TEST(FileBytes, OfAGltfWithFilesBesideIt) {
  GltfBuilder b = GltfBuilder::triangle();
  b.json["buffers"][0]["uri"] = "a.bin";
  b.json["images"] = Json::array({{{"uri", "a.png"}}});
  const TempFolder folder;
  const std::vector files{folder.add("a.gltf", b.json.dump()), folder.add("a.bin", test::text_of(b.binary)),
                          folder.add("a.png", test::tiny_png())};
  const FileBytes bytes = measure(files[0]);
  EXPECT_EQ(bytes.format, FileFormat::gltf);
  EXPECT_EQ(bytes.files, size_of_all(files));
  EXPECT_EQ(bytes.kinds.geometry, kTriangle);
  EXPECT_EQ(bytes.kinds.images, test::tiny_png().size());
  EXPECT_EQ(bytes.kinds.total(), bytes.files);
}

TEST(FileBytes, OfCompressedViewsAreTheCompressedOnes) {
  const Json view = {{"buffer", 1},
                     {"byteLength", 1000},
                     {"extensions", {{"EXT_meshopt_compression", {{"buffer", 0}, {"byteLength", 70}}}}}};
  const Json root = {{"asset", {{"version", "2.0"}}},
                     {"bufferViews", {view}},
                     {"accessors", {{{"bufferView", 0}}}},
                     {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}, {{"indices", 0}}}}}}}};
  const TempFolder folder;
  const auto path = folder.add("a.gltf", root.dump());
  EXPECT_EQ(measure_input(path, {}).kinds.geometry, 70u) << "once, however often it is used";
}

TEST(FileBytes, OfPointsAreNotGeometryThatFoveaChanges) {
  GltfBuilder b = GltfBuilder::triangle();
  b.json["meshes"][0]["primitives"][0]["mode"] = 0;
  const TempFolder folder;
  EXPECT_EQ(measure_input(folder.add("a.glb", test::text_of(b.glb())), {}).kinds.geometry, 0u);
}

TEST(FileBytes, OfAnObjWithItsMaterialsAndImages) {
  const TempFolder folder;
  const std::vector files{
      folder.add("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n"),
      folder.add("a.mtl", "newmtl m\nmap_Kd a.png\n"), folder.add("a.png", test::tiny_png())};
  const FileBytes bytes = measure(files[0]);
  EXPECT_EQ(bytes.format, FileFormat::obj);
  EXPECT_EQ(bytes.files, size_of_all(files));
  EXPECT_EQ(bytes.kinds.geometry, std::filesystem::file_size(files[0]));
  EXPECT_EQ(bytes.kinds.images, std::filesystem::file_size(files[2]));
  EXPECT_EQ(bytes.kinds.total(), bytes.files);
}

TEST(FileBytes, OfWhatWasWritten) {
  const TempFolder folder;
  const Model model = test::model_of(test::grid(4, 4));
  for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.ply"}) {
    Context context;
    const auto files = write_model(model, folder.path() / name, {}, context);
    const FileBytes bytes = measure_output(files, model);
    EXPECT_EQ(to_string(bytes.format), files[0].extension().string().substr(1));
    EXPECT_EQ(bytes.files, size_of_all(files)) << name;
    EXPECT_EQ(bytes.kinds.total(), bytes.files) << name;
    EXPECT_GT(bytes.kinds.geometry, 25u * 12) << name;
  }
}

TEST(FileBytes, OfAMissingFileAreAnError) {
  const TempFolder folder;
  test::expect_error([&] { measure_input(folder.path() / "none.glb", {}); }, ErrorKind::input, "none.glb");
}

}  // namespace
}  // namespace fovea
