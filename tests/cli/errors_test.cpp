#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "run_command.h"

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
  EXPECT_THAT(outcome.err, HasSubstr("max-elements"));
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
  EXPECT_EQ(json["schema_version"], 1);
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
