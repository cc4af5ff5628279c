#include "fovea/io/write.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "support/corner_soup.h"
#include "support/meshes.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

std::vector<std::byte> text_bytes(const std::string& text) {
  std::vector<std::byte> result;
  for (const char c : text) result.push_back(static_cast<std::byte>(c));
  return result;
}

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A new folder that goes with the test.
class Write : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "fovea_write_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  std::vector<std::string> files() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      result.push_back(entry.path().lexically_relative(folder_).generic_string());
    }
    std::sort(result.begin(), result.end());
    return result;
  }
  template <class Call>
  static Error error_of(const Call& call) {
    try {
      call();
    } catch (const Error& e) {
      return e;
    }
    ADD_FAILURE() << "nothing was thrown";
    return Error(ErrorKind::internal, "nothing");
  }

  fs::path folder_;
};

TEST_F(Write, AllFilesStandInTheirPlacesAndNothingElse) {
  const std::vector<OutputFile> files_to_write = {
      {"", text_bytes("main")}, {"side.bin", text_bytes("side")}, {"a/b/c.png", {}}};
  write_files(folder_ / "out.gltf", files_to_write, false);
  EXPECT_EQ(files(), (std::vector<std::string>{"a", "a/b", "a/b/c.png", "out.gltf", "side.bin"}));
  EXPECT_EQ(content(folder_ / "out.gltf"), "main");
  EXPECT_EQ(content(folder_ / "side.bin"), "side");
}

TEST_F(Write, ExistingFilesAreOnlyReplacedWithForce) {
  const std::vector<OutputFile> old_files = {{"", text_bytes("old")}, {"side", text_bytes("old side")}};
  const std::vector<OutputFile> new_files = {{"", text_bytes("new")}, {"side", text_bytes("new side")}};
  write_files(folder_ / "x", old_files, false);
  const Error error = error_of([&] { write_files(folder_ / "x", new_files, false); });
  EXPECT_EQ(error.kind(), ErrorKind::usage);
  EXPECT_NE(error.hint().find("--force"), std::string::npos);
  EXPECT_EQ(content(folder_ / "x"), "old");
  write_files(folder_ / "x", new_files, true);
  EXPECT_EQ(content(folder_ / "x"), "new");
  EXPECT_EQ(content(folder_ / "side"), "new side");
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(Write, ASideFileThatIsThereAlreadyIsLeftAlone) {
  write_files(folder_ / "image.png", std::vector<OutputFile>{{"", text_bytes("pixels")}}, false);
  const auto before = fs::last_write_time(folder_ / "image.png");
  write_files(folder_ / "out",
              std::vector<OutputFile>{{"", text_bytes("main")}, {"image.png", text_bytes("pixels")}}, false);
  EXPECT_EQ(fs::last_write_time(folder_ / "image.png"), before);
  const auto other = std::vector<OutputFile>{{"", text_bytes("main")}, {"image.png", text_bytes("pixelS")}};
  EXPECT_EQ(error_of([&] { write_files(folder_ / "other", other, false); }).kind(), ErrorKind::usage);
  EXPECT_FALSE(fs::exists(folder_ / "other"));
}

TEST_F(Write, ReplacedFilesKeepTheirPermissions) {
  write_files(folder_ / "x", std::vector<OutputFile>{{"", text_bytes("old")}}, false);
  fs::permissions(folder_ / "x", fs::perms::owner_read | fs::perms::owner_write);
  write_files(folder_ / "x", std::vector<OutputFile>{{"", text_bytes("new")}}, true);
  EXPECT_EQ(fs::status(folder_ / "x").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Write, PlacesThatCannotBeWrittenAreToldBeforeTheWork) {
  EXPECT_EQ(error_of([&] { check_output(folder_ / "none" / "x.glb", true); }).kind(), ErrorKind::output);
  fs::create_directory(folder_ / "folder.glb");
  EXPECT_EQ(error_of([&] { check_output(folder_ / "folder.glb", true); }).kind(), ErrorKind::output);
  EXPECT_EQ(error_of([&] { check_output(folder_ / "x.stl", true); }).kind(), ErrorKind::usage);
  EXPECT_EQ(error_of([&] { check_output(folder_ / "x", true); }).kind(), ErrorKind::usage);
  write_files(folder_ / "x.glb", std::vector<OutputFile>{{"", {}}}, false);
  EXPECT_EQ(error_of([&] { check_output(folder_ / "x.glb", false); }).kind(), ErrorKind::usage);
  EXPECT_EQ(error_of([&] { check_output(folder_ / "x.glb" / "y.glb", true); }).kind(), ErrorKind::output);
  EXPECT_NO_THROW(check_output(folder_ / "x.glb", true));
  EXPECT_NO_THROW(check_output(folder_ / "y.GLB", false));
}

TEST_F(Write, DevicesAreNotReplaced) {
  EXPECT_EQ(error_of([] {
              write_files("/dev/null", std::vector<OutputFile>{{"", {}}}, true);
            }).kind(),
            ErrorKind::output);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Write, NothingIsLeftBehindOnFailure) {
  // The second side file cannot be made: a file stands where its folder should be.
  write_files(folder_ / "blocked", std::vector<OutputFile>{{"", text_bytes("x")}}, false);
  const std::vector<OutputFile> out = {
      {"", text_bytes("main")}, {"new/side", text_bytes("s")}, {"blocked/side", text_bytes("s")}};
  EXPECT_EQ(error_of([&] { write_files(folder_ / "out", out, true); }).kind(), ErrorKind::output);
  EXPECT_EQ(files(), std::vector<std::string>{"blocked"});
}

TEST_F(Write, AFullDiskIsAnErrorAndLeavesNothing) {
  // A limit on the size of files fails like a full disk, in the middle of writing.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::vector<OutputFile> out = {{"", text_bytes("main")}, {"side", std::vector<std::byte>(1 << 20)}};
  const Error error = error_of([&] { write_files(folder_ / "x", out, false); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(error.kind(), ErrorKind::output);
  EXPECT_TRUE(files().empty());
}

TEST_F(Write, ForbiddenFoldersAreErrors) {
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  if (access(folder_.c_str(), W_OK) == 0) GTEST_SKIP() << "permissions do not bind this user";
  EXPECT_EQ(error_of([&] {
              write_files(folder_ / "x", std::vector<OutputFile>{{"", {}}}, false);
            }).kind(),
            ErrorKind::output);
}

TEST_F(Write, NamesOutsideOfTheFolderAreRefused) {
  for (const char* name : {"../x", "/tmp/x", "a/../../x"}) {
    const std::vector<OutputFile> out = {{"", {}}, {name, {}}};
    EXPECT_EQ(error_of([&] { write_files(folder_ / "x", out, true); }).kind(), ErrorKind::internal) << name;
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(Write, ModelsReadBackFromEveryFormat) {
  const TriMesh cube = test::cube();
  Context context;
  for (const char* name : {"cube.glb", "cube.gltf", "cube.obj", "cube.ply"}) {
    write_model(test::model_of(cube), folder_ / name, {}, context);
    const Model read = read_model(folder_ / name, {}, context);
    ASSERT_EQ(read.meshes.size(), 1u) << name;
    EXPECT_EQ(read.meshes[0].surface.face_count(), cube.face_count()) << name;
    EXPECT_EQ(read.meshes[0].surface.vertex_count(), cube.vertex_count()) << name;
  }
  EXPECT_TRUE(test::corner_soup(read_model(folder_ / "cube.gltf", {}, context).meshes[0].surface) ==
              test::corner_soup(cube));
}

TEST_F(Write, WhatTheFormatHasNoUseForIsRefused) {
  WriteOptions quantized, compressed;
  quantized.quantize = true;
  compressed.compression = GeometryCompression::meshopt;
  Context context;
  for (const char* name : {"x.obj", "x.PLY"}) {
    const auto refused = [&](const WriteOptions& options) {
      return error_of([&] { write_model(test::model_of(test::cube()), folder_ / name, options, context); });
    };
    EXPECT_EQ(refused(quantized).kind(), ErrorKind::usage);
    EXPECT_EQ(refused(quantized).message(), "--quantize is for .glb and .gltf");
    EXPECT_EQ(refused(compressed).message(), "--compression is for .glb and .gltf");
  }
  EXPECT_NO_THROW(check_output(folder_ / "x.GLB", quantized));
  EXPECT_TRUE(files().empty());
}

TEST_F(Write, OptionsAreChecked) {
  WriteOptions options;
  options.position_bits = 17;
  Context context;
  const Error error =
      error_of([&] { write_model(test::model_of(test::cube()), folder_ / "x.glb", options, context); });
  EXPECT_EQ(error.kind(), ErrorKind::usage);
  EXPECT_NE(std::string(error.what()).find("position-bits"), std::string::npos);
  EXPECT_TRUE(files().empty());
}

TEST(WriteOptionsTest, EveryOptionIsDescribed) {
  WriteOptions options;
  for (Option& option : describe(options)) {
    EXPECT_FALSE(option.help.empty()) << option.name;
    if (option.name == "compression") option.parse("meshopt");
    if (option.name == "quantize" || option.name == "force") option.parse("true");
    if (option.name.ends_with("-bits")) option.parse("10");
  }
  EXPECT_TRUE(options.quantize);
  EXPECT_TRUE(options.force);
  EXPECT_EQ(options.compression, GeometryCompression::meshopt);
  EXPECT_EQ(options.position_bits + options.uv_bits + options.normal_bits + options.color_bits, 40);
}

}  // namespace
}  // namespace fovea
