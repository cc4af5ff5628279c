#include "fovea/io/read.h"

#include <gtest/gtest.h>

#include "support/reading.h"

namespace fovea {
namespace {

using test::bytes_of;
using test::expect_error;
using test::TempFolder;

FileFormat detect(const std::string& content, const std::string& name) {
  return detect_format(bytes_of(content), name);
}

TEST(Read, ContentDecidesBeforeTheName) {
  EXPECT_EQ(detect("glTF....", "a.obj"), FileFormat::glb);
  EXPECT_EQ(detect("  {\"asset\": {}}", "a.txt"), FileFormat::gltf);
  EXPECT_EQ(detect("\xEF\xBB\xBF{\"asset\": {}}", "a.glb"), FileFormat::gltf);
  EXPECT_EQ(detect("ply\nformat", "a.stl"), FileFormat::ply);
  EXPECT_EQ(detect("solid x\nfacet normal 0 0 1", "a.ply"), FileFormat::stl);
  EXPECT_EQ(detect("# comment\nmtllib a.mtl\nv 0 0 0\n", "a.bin"), FileFormat::obj);
  std::string stl(84 + 50, '\0');
  stl[80] = 1;
  EXPECT_EQ(detect(stl, "a.xyz"), FileFormat::stl);
}

TEST(Read, TheNameDecidesWhenContentDoesNotTell) {
  EXPECT_EQ(detect("{broken", "a.gltf"), FileFormat::gltf);
  EXPECT_EQ(detect("nonsense", "a.GLB"), FileFormat::glb);
  EXPECT_EQ(detect("nonsense", "a.Obj"), FileFormat::obj);
  EXPECT_EQ(detect("nonsense", "a.ply"), FileFormat::ply);
  EXPECT_EQ(detect("nonsense", "a.stl"), FileFormat::stl);
  EXPECT_EQ(detect("nonsense", "a.fbx"), FileFormat::other);
  EXPECT_EQ(detect("v for vendetta\nand more", "a.txt"), FileFormat::other);
  EXPECT_EQ(detect("", "a.txt"), FileFormat::other);
}

TEST(Read, LongObjFilesAreToldByTheirBeginning) {
  std::string text = "# long\n";
  while (text.size() < 10000) text += "v 0.25 0.5 0.75\n";
  EXPECT_EQ(detect(text + "unknown words far below\n", "a"), FileFormat::obj);
}

TEST(Read, MissingFoldersAndEmptyFilesAreToldApart) {
  TempFolder folder;
  Context context;
  expect_error([&] { read_model(folder.path() / "no.obj", {}, context); }, ErrorKind::input, "no.obj",
               "no such file");
  expect_error([&] { read_model(folder.path(), {}, context); }, ErrorKind::input, folder.path().string(),
               "folder");
  const auto empty = folder.add("empty.obj", "");
  expect_error([&] { read_model(empty, {}, context); }, ErrorKind::format, "empty.obj", "empty");
  const auto text = folder.add("letter.txt", "Dear reader,\n");
  expect_error([&] { read_model(text, {}, context); }, ErrorKind::unsupported, "letter.txt");
}

TEST(Read, WholeFilesAndLimits) {
  TempFolder folder;
  const std::string content(3000, 'x');
  const auto file = folder.add("a", content);
  EXPECT_EQ(test::text_of(read_file(file, 3000)), content);
  expect_error([&] { read_file(file, 2999); }, ErrorKind::limit, "a");
  EXPECT_EQ(read_file(folder.add("b", ""), 0).size(), 0u);
}

TEST(Read, AGlbThatIsNone) {
  TempFolder folder;
  Context context;
  const auto file = folder.add("a.glb", "<html>not found</html>");
  expect_error([&] { read_model(file, {}, context); }, ErrorKind::format, "a.glb", "not a GLB file");
}

TEST(Read, PipesAreReadToTheirEnd) {
  TempFolder folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::system(("mkfifo " + pipe.string() + " && (printf hello > " + pipe.string() + " &)").c_str()),
            0);
  EXPECT_EQ(test::text_of(read_file(pipe, 100)), "hello");
}

TEST(Read, OptionsAreDescribedAndChecked) {
  ReadOptions options;
  OptionList list = describe(options);
  ASSERT_EQ(list.size(), 4u);
  list[1].parse("17");
  EXPECT_EQ(options.max_elements, 17);
  EXPECT_TRUE(test::error_of([&] { list[0].parse("0"); }));
}

}  // namespace
}  // namespace fovea
