#include <gtest/gtest.h>

#include "io/gltf_written.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using nlohmann::json;
using test::Written;

TEST(GltfImagesWrite, TexturesNameTheirImageWhereItsTypeBelongs) {
  const std::vector<std::uint8_t> ktx2 = {0xAB, 'K',  'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n',
                                          0x1A, '\n', 0,   0,   0,   0,   1,   0,    0,    0,
                                          4,    0,    0,   0,   4,   0,   0,   0};
  Model model;
  model.images.resize(2);
  model.images[0].mime_type = "image/png";
  model.images[0].bytes = {1};
  model.images[1].bytes = ktx2;
  model.textures.resize(3);
  model.textures[0].image = 0;
  model.textures[1].image = 1;
  model.textures[2].image = 1;  // with a fallback that stays
  model.textures[2].json = R"({"source":0,"extensions":{"KHR_texture_basisu":{"source":1}}})";
  const Written written(model);
  EXPECT_EQ(written.json["textures"][0], json::parse(R"({"source":0})"));
  EXPECT_EQ(written.json["textures"][1],
            json::parse(R"({"extensions":{"KHR_texture_basisu":{"source":1}}})"));
  EXPECT_EQ(written.json["textures"][2], json::parse(model.textures[2].json));
  EXPECT_EQ(written.json["images"][1]["mimeType"], "image/ktx2");
  EXPECT_TRUE(test::lists(written.json, "extensionsUsed", "KHR_texture_basisu"));
  EXPECT_TRUE(test::lists(written.json, "extensionsRequired", "KHR_texture_basisu"));
}

TEST(GltfImagesWrite, ImagesOfAGlbAreEmbeddedOnceAndByteForByte) {
  Model model;
  model.images.resize(3);
  model.images[0].bytes = {0xFF, 0xD8, 0xFF, 1, 2};
  model.images[0].mime_type = "image/jpeg";
  model.images[0].uri = "folder/a.jpg";
  model.images[1].bytes = {9};
  model.images[1].mime_type = "image/png";
  model.images[2] = model.images[0];
  const Written written(model);
  EXPECT_EQ(written.counts.images, 6u);
  EXPECT_EQ(written.json["images"][0], json::parse(R"({"bufferView":0,"mimeType":"image/jpeg"})"));
  EXPECT_EQ(written.json["images"][2]["bufferView"], 0);
  EXPECT_EQ(written.read().images[0].bytes, model.images[0].bytes);
}

std::vector<std::string> names_of(const GltfOutput& output) {
  std::vector<std::string> names;
  for (const OutputFile& file : output.files) names.push_back(file.name);
  return names;
}

TEST(GltfImagesWrite, FilesOfAGltfStandBesideIt) {
  Model model = test::model_of(test::cube());
  model.images.resize(3);
  model.images[0].uri = "my textures/a b.png";
  model.images[0].mime_type = "image/png";
  model.images[0].bytes = {1};
  model.images[1].mime_type = "image/webp";  // came embedded
  model.images[1].bytes = {2};
  model.images[2].uri = "c.png";  // was made anew in another format
  model.images[2].mime_type = "image/jpeg";
  model.images[2].bytes = {3};
  Context context;
  const GltfOutput output = write_gltf(model, false, "out file", {}, context);
  EXPECT_EQ(names_of(output), (std::vector<std::string>{"", "out file.bin", "my textures/a b.png",
                                                        "out file_image1.webp", "c.jpg"}));
  const auto* text = reinterpret_cast<const char*>(output.files[0].bytes.data());
  const json root = json::parse(std::string(text, output.files[0].bytes.size()));
  EXPECT_EQ(root["buffers"][0]["uri"], "out%20file.bin");
  EXPECT_EQ(root["buffers"][0]["byteLength"], output.files[1].bytes.size());
  EXPECT_EQ(root["images"][0]["uri"], "my%20textures/a%20b.png");
  std::uint64_t total = 0;
  for (const OutputFile& file : output.files) total += file.bytes.size();
  EXPECT_EQ(output.bytes.total(), total);
  EXPECT_EQ(output.bytes.images, 3u);
}

TEST(GltfImagesWrite, ImageNamesCannotLeaveTheFolderNorClash) {
  Model model;
  for (const char* uri : {"../../etc/a.png", "/etc/b.png", "C:\\c.png", "http://x/y.png", "Makefile", "m.bin",
                          "same.png", "Same.png", "same.png"}) {
    EncodedImage image;
    image.uri = uri;
    image.mime_type = "image/png";
    image.bytes = {static_cast<std::uint8_t>(model.images.size())};
    model.images.push_back(image);
  }
  model.images[8].bytes = model.images[6].bytes;  // the same image twice
  Context context;
  const auto names = names_of(write_gltf(model, false, "m", {}, context));
  EXPECT_EQ(names,
            (std::vector<std::string>{"", "m_image0.png", "m_image1.png", "m_image2.png", "m_image3.png",
                                      "Makefile.png", "m.png", "same.png", "Same_2.png"}));
}

}  // namespace
}  // namespace fovea
