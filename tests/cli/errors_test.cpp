#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "run_command.h"
#include "support/gltf_builder.h"

namespace fovea::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Errors, MissingFile) {
  const Outcome outcome = fovea({"info", "no/such.glb"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "fovea: error: no/such.glb: no such file\n");
  EXPECT_THAT(outcome.out, IsEmpty());
}

TEST(Errors, FolderAsInput) {
  const Folder folder;
  EXPECT_EQ(fovea({"info", folder / ""}).code, 3);
}

TEST(Errors, TruncatedFile) {
  const Folder folder;
  const std::string whole = read_text(write_grid(folder, "grid.glb"));
  const std::string half = folder.write("half.glb", whole.substr(0, whole.size() / 2));
  const Outcome outcome = fovea({"simplify", half, "-o", folder / "out.glb", "--ratio", "0.5"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("half.glb"));
  EXPECT_THAT(folder.names(), ElementsAre("grid.glb", "half.glb"));
}

TEST(Errors, OverALimitNamesTheOption) {
  const Folder folder;
  const Outcome outcome = fovea({"info", write_grid(folder, "grid.glb"), "--max-elements", "10"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("raise --max-elements"));
}

TEST(Errors, OutputInNoFolder) {
  const Folder folder;
  const Outcome outcome = fovea({"sample", "vase", "-o", folder / "none/vase.glb"});
  EXPECT_EQ(outcome.code, 7);
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Errors, OutputIsAFolder) {
  const Folder folder;
  std::filesystem::create_directory(folder / "x.glb");
  EXPECT_EQ(fovea({"sample", "vase", "-o", folder / "x.glb", "--force"}).code, 7);
}

// /proc takes no files, whoever asks.
TEST(Errors, OutputCannotBeWritten) {
  const Folder folder;
  const std::string grid = write_grid(folder, "grid.glb");
  const Outcome outcome = fovea({"simplify", grid, "-o", "/proc/grid.glb", "--ratio", "0.5"});
  EXPECT_EQ(outcome.code, 7);
  EXPECT_THAT(outcome.err, HasSubstr("/proc"));
}

TEST(Errors, FullStandardOutput) { EXPECT_EQ(fovea({"sample", "--list"}, "/dev/full").code, 7); }

TEST(Errors, StandardStreamsAreNotModels) {
  EXPECT_THAT(fovea({"sample", "vase", "-o", "-"}).err, HasSubstr("standard output is not supported"));
  EXPECT_THAT(fovea({"info", "-"}).err, HasSubstr("standard input is not supported"));
}

TEST(Errors, UnknownOutputFormatIsRefusedBeforeTheWork) {
  const Folder folder;
  const Outcome outcome =
      fovea({"simplify", write_grid(folder, "grid.glb"), "-o", folder / "out.abc", "--ratio", "0.5"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(folder.names(), ElementsAre("grid.glb"));
}

TEST(Errors, OptionsThatTheFormatHasNoUseFor) {
  const Folder folder;
  const std::string grid = write_grid(folder, "grid.glb");
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--quantize"}, {"--compression", "meshopt"}}) {
    std::vector<std::string> words{"simplify", grid, "-o", folder / "x.obj", "--ratio", "0.5"};
    words.insert(words.end(), option.begin(), option.end());
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(option[0] + " is for .glb and .gltf"));
  }
  EXPECT_THAT(folder.names(), ElementsAre("grid.glb"));
}

TEST(Errors, NoOutputNamed) {
  const Folder folder;
  const Outcome outcome = fovea({"simplify", write_grid(folder, "grid.glb"), "--ratio", "0.5"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("-o"));
}

TEST(Errors, NoTargetNamesThemAll) {
  const Folder folder;
  const Outcome outcome = fovea({"simplify", write_grid(folder, "grid.glb"), "-o", folder / "out.glb"});
  EXPECT_EQ(outcome.code, 2);
  for (const char* target : {"--ratio 0.1", "--triangles", "--error", "--error-abs"}) {
    EXPECT_THAT(outcome.err, HasSubstr(target));
  }
}

TEST(Errors, ExistingOutputIsKept) {
  const Folder folder;
  const std::string grid = write_grid(folder, "grid.glb"), other = folder.write("other.glb", "precious");
  const Outcome outcome = fovea({"simplify", grid, "-o", other, "--ratio", "0.5"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--force"));
  EXPECT_EQ(read_text(other), "precious");
}

TEST(Errors, InputIsKeptUnderAnyName) {
  const Folder folder;
  const std::string grid = write_grid(folder, "grid.glb"), before = read_text(grid);
  std::filesystem::create_symlink(grid, folder / "link.glb");
  for (const std::string& output : {grid, folder / "./grid.glb", folder / "link.glb"}) {
    const Outcome outcome = fovea({"simplify", grid, "-o", output, "--ratio", "0.5"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("the output is an input"));
  }
  EXPECT_EQ(read_text(grid), before);
}

TEST(Errors, JsonHoldsTheError) {
  const Outcome outcome = fovea({"info", "no/such.glb", "--json"});
  EXPECT_EQ(outcome.code, 3);
  const nlohmann::json json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["verb"], "info");
  EXPECT_EQ(json["exit_code"], 3);
  EXPECT_EQ(json["error"]["kind"], "input");
  EXPECT_EQ(json["error"]["place"], "no/such.glb");
  EXPECT_TRUE(json["error"].contains("message"));
  EXPECT_TRUE(json["error"].contains("hint"));
}

TEST(Errors, JsonHoldsUsageErrorsToo) {
  const nlohmann::json json = fovea({"simplify", "--json", "--ratoi", "1"}).json();
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["error"]["kind"], "usage");
  EXPECT_EQ(json["exit_code"], 2);
}

TEST(Errors, AFailedRunKeepsItsReport) {
  const Folder folder;
  const std::string grid = write_grid(folder, "grid.glb");
  const Outcome outcome = fovea({"render", grid, "-o", folder / "x.png", "--views", "cameras", "--json"});
  EXPECT_EQ(outcome.code, 5);
  const nlohmann::json json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["error"]["kind"], "unsupported");
  EXPECT_EQ(json["error"]["place"], grid);
  EXPECT_EQ(json["exit_code"], 5);
  EXPECT_EQ(json["options"]["views"], "cameras");
  EXPECT_EQ(json["inputs"][0]["path"], grid);
  EXPECT_EQ(json["phases"][0]["name"], "read");
  EXPECT_TRUE(json["diagnostics"].is_array());
}

// Scenes may be empty: what works on any model lets them through, what draws has nothing to do.
TEST(Errors, ModelsWithoutTriangles) {
  GltfBuilder builder;
  const int positions = builder.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 0}});
  const std::vector<std::byte> bytes = builder.glb();
  const Folder folder;
  const std::string grid = write_grid(folder, "grid.glb"),
                    points = folder.write("points.glb",
                                          {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::string note = "fovea: note: " + points + ": the model has no triangles\n";
  EXPECT_EQ(fovea({"info", points}).err, note);
  for (const char* saliency : {"none", "auto", "lee"}) {
    const Outcome outcome = fovea(
        {"simplify", points, "-o", folder / "x.glb", "--ratio", "0.5", "--force", "--saliency", saliency});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, note);
  }
  EXPECT_THAT(fovea({"info", folder / "x.glb"}).out, HasSubstr("points")) << "they are still there";
  const std::vector<std::string> refused[] = {{"render", points, "-o", folder / "x.png"},
                                              {"saliency", points, "-o", folder / "x.npy"},
                                              {"compare", points, grid},
                                              {"compare", grid, points}};
  for (const std::vector<std::string>& words : refused) {
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 5) << words[0];
    EXPECT_THAT(outcome.err, HasSubstr("error: " + points + ": the model has no triangles"));
  }
}

// The signal comes while the model is read, and 320,000 triangles take far longer to simplify than the
// hundredth of a second that the test may be late.
TEST(Cancel, LeavesNoDebris) {
  const Folder folder;
  const std::string grid = write_grid(folder, "grid.glb", 400);
  for (const int signal : {SIGINT, SIGTERM}) {
    Running running({"simplify", grid, "-o", folder / "out.glb", "--ratio", "0.1", "--verbose"});
    ASSERT_TRUE(running.wait_for_talk());
    running.send(signal);
    const Outcome outcome = running.wait();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("fovea: error: cancelled"));
    EXPECT_THAT(folder.names(), ElementsAre("grid.glb"));
  }
}

}  // namespace
}  // namespace fovea::test
