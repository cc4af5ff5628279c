// What goes wrong around a run: no room to write, no memory, Ctrl-C, files that come and go.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "run_command.h"

namespace fovea::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

/// A command that writes `name`, whatever folder that is in.
struct Writer {
  Words words;
  std::string name;

  Words to(const std::string& folder) const {
    Words all = words;
    all.insert(all.end(), {words[0] == "compare" ? "--report" : "-o", folder + "/" + name});
    return all;
  }
};

/// Every verb that writes, with each kind of output.
std::vector<Writer> writers(const std::string& model) {
  return {{{"simplify", model, "--ratio", "0.5"}, "x.glb"},
          {{"simplify", model, "--ratio", "0.5"}, "x.gltf"},
          {{"simplify", model, "--ratio", "0.5"}, "x.obj"},
          {{"focus", model, "--at", "128,128", "--ratio", "0.5"}, "x.glb"},
          {{"focus", model, "--at", "128,128", "--error", "0.01"}, "x.png"},
          {{"fit", model, "--bytes", "20KB", "--view-size", "64"}, "x.glb"},
          {{"lods", model, "--no-pictures", "--distance-samples", "500"}, "x"},
          {{"lods", model, "--no-pictures", "--distance-samples", "500"}, "x.glb"},
          {{"lods", model}, "x.fovea"},
          {{"texture", model, "--max-texture", "8"}, "x.glb"},
          {{"saliency", model}, "x.glb"},
          {{"saliency", model}, "x.npy"},
          {{"segment", model}, "x.json"},
          {{"fly", model, "--device", "cpu", "--frames", "4", "--view-size", "64"}, "x.csv"},
          {{"compare", model, model, "--view-size", "64"}, "x.html"},
          {{"render", model, "--view-size", "64"}, "x.png"},
          {{"sample", "vase", "--detail", "0.1"}, "x.glb"}};
}

class Trouble : public ::testing::Test {
 protected:
  Folder inputs_, outputs_;
  std::string grid_ = write_grid(inputs_, "grid.glb");
  std::vector<Writer> writers_ = writers(grid_);
  std::string folder_ = outputs_ / ".";
};

// A limit on the size of files is met in the middle of writing, as the end of a disk is.
TEST_F(Trouble, AFullDiskIsSaidAndNothingIsLeft) {
  for (const Writer& writer : writers_) {
    const Outcome outcome = fovea_within("-f 1", writer.to(folder_));
    EXPECT_EQ(outcome.code, 7) << writer.words[0] << " " << writer.name << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("cannot write: File too large"));
    EXPECT_THAT(outputs_.names(), ElementsAre()) << writer.words[0] << " " << writer.name;
  }
}

// /proc takes no files, whoever asks.
TEST_F(Trouble, AFolderThatTakesNoFiles) {
  for (const Writer& writer : writers_) {
    const Outcome outcome = fovea(writer.to("/proc"));
    EXPECT_EQ(outcome.code, 7) << writer.words[0] << " " << writer.name << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("/proc/x"));
  }
}

TEST_F(Trouble, AReadOnlyFolder) {
  fs::permissions(outputs_ / ".", fs::perms::owner_read | fs::perms::owner_exec);
  if (access(folder_.c_str(), W_OK) == 0) GTEST_SKIP() << "permissions do not bind this user";
  for (const Writer& writer : writers_) EXPECT_EQ(fovea(writer.to(folder_)).code, 7) << writer.words[0];
  fs::permissions(outputs_ / ".", fs::perms::owner_all);
  EXPECT_THAT(outputs_.names(), ElementsAre());
}

TEST_F(Trouble, AFolderThatIsNotThere) {
  for (const Writer& writer : writers_)
    EXPECT_EQ(fovea(writer.to(outputs_ / "none/deeper")).code, 7) << writer.words[0] << " " << writer.name;
  EXPECT_THAT(outputs_.names(), ElementsAre());
}

// Names may have 255 bytes.
TEST_F(Trouble, ANameThatIsTooLong) {
  const std::string tail(300, 'x');
  for (const Writer& writer : writers_) {
    const Outcome outcome = fovea(Writer{writer.words, tail + writer.name}.to(folder_));
    EXPECT_EQ(outcome.code, 7) << writer.words[0] << " " << writer.name << "\n" << outcome.err;
    if (writer.words[0] == "sample") continue;
    Words words = writer.to(folder_);
    words[1] = tail;
    EXPECT_EQ(fovea(words).code, 3) << writer.words[0];
  }
}

TEST_F(Trouble, TheInputAsOutput) {
  const std::string before = read_text(grid_);
  for (const Writer& writer : writers_) {
    if (fs::path(writer.name).extension() != ".glb" || writer.words[0] == "sample") continue;
    Words words = writer.words;
    words.insert(words.end(), {"-o", grid_});
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 2) << writer.words[0];
    EXPECT_THAT(outcome.err, HasSubstr("the output is an input"));
  }
  EXPECT_TRUE(read_text(grid_) == before);
}

TEST_F(Trouble, PipesAndDevicesAreNoModels) {
  const std::string pipe = inputs_ / "pipe.glb";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& input : {pipe, std::string("/dev/zero"), std::string("/dev/null")}) {
    for (const Words& words :
         {Words{"info", input}, {"simplify", input, "-o", outputs_ / "x.glb", "--ratio", "0.5"}}) {
      const Outcome outcome = fovea(words);
      EXPECT_EQ(outcome.code, 3) << input;
      EXPECT_THAT(outcome.err, HasSubstr(input + ": this is not an ordinary file"));
    }
  }
}

// The input goes as soon as it has been read: what is in memory is enough, or the file is missed by name.
TEST_F(Trouble, AnInputThatVanishes) {
  for (const Writer& writer : writers_) {
    if (writer.words[0] == "sample") continue;
    const std::string model = write_grid(inputs_, "going.glb", 60);
    Words words = writer.to(folder_);
    std::replace(words.begin(), words.end(), grid_, model);
    words.push_back("--verbose");
    Running running(words);
    ASSERT_TRUE(running.wait_for_talk("read 0")) << writer.words[0];
    fs::remove(model);
    const Outcome outcome = running.wait();
    EXPECT_THAT(outcome.code, ::testing::AnyOf(0, 3, 8)) << writer.words[0] << "\n" << outcome.err;
    if (outcome.code == 3) {
      EXPECT_THAT(outputs_.names(), ElementsAre());
    }
    for (const std::string& name : outputs_.names()) fs::remove_all(outputs_ / name);
  }
}

// Ctrl-C at any time: what is there then is all or nothing, and it does not take long.
TEST_F(Trouble, CtrlCLeavesNothingHalf) {
  const std::string large = write_grid(inputs_, "large.glb", 120);
  for (const Writer& writer : writers_) {
    for (const int milliseconds : {0, 60, 250}) {
      Words words = writer.to(folder_);
      std::replace(words.begin(), words.end(), grid_, large);
      words.push_back("--verbose");
      Running running(words);
      ASSERT_TRUE(running.wait_for_talk());
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      const auto sent = std::chrono::steady_clock::now();
      running.send(SIGINT);
      const Outcome outcome = running.wait();
      const std::string what = writer.words[0] + " " + writer.name + "\n" + outcome.err;
      EXPECT_THAT(outcome.code, ::testing::AnyOf(0, 8, 130)) << what;
      if (outcome.err.find("the best so far is written") != std::string::npos) {
        EXPECT_EQ(writer.words[0], "fit") << what;
        EXPECT_THAT(outputs_.names(), ElementsAre(writer.name)) << what;
        EXPECT_EQ(fovea({"info", outputs_ / writer.name, "--json"}).code, 0) << what;
      } else if (outcome.code == 130) {
        EXPECT_THAT(outputs_.names(), ElementsAre()) << what;
        EXPECT_THAT(outcome.err, HasSubstr("fovea: error: cancelled"));
      }
      // On a busy machine ten times what it should be.
      EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(10)) << what;
      for (const std::string& name : outputs_.names()) fs::remove_all(outputs_ / name);
    }
  }
}

// Of the address space: what the program itself takes, and little more. Sanitisers need far more than that.
TEST_F(Trouble, TooLittleMemoryIsSaid) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitisers reserve more than any limit";
#endif
  const std::string large = write_grid(inputs_, "large.glb", 400);
  for (const Writer& writer : writers_) {
    if (writer.words[0] == "sample") continue;
    Words words = writer.to(folder_);
    std::replace(words.begin(), words.end(), grid_, large);
    const Outcome outcome = fovea_within("-v 100000", words);
    EXPECT_EQ(outcome.code, 6) << writer.words[0] << " " << writer.name << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("out of memory"));
    EXPECT_THAT(outputs_.names(), ElementsAre());
  }
}

// Wherever memory runs out, it is said; libraries that meet it first do not end the program.
TEST_F(Trouble, AnyMemoryIsEnoughOrItIsSaid) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitisers reserve more than any limit";
#endif
  for (const Writer& writer : writers_) {
    for (const char* kilobytes : {"-v 110000", "-v 150000", "-v 220000"}) {
      const Outcome outcome = fovea_within(kilobytes, writer.to(folder_));
      const std::string what = writer.words[0] + " " + writer.name + " " + kilobytes + "\n" + outcome.err;
      EXPECT_THAT(outcome.code, ::testing::AnyOf(0, 6, 8)) << what;
      if (outcome.code == 6) {
        EXPECT_THAT(outputs_.names(), ElementsAre()) << what;
      }
      for (const std::string& name : outputs_.names()) fs::remove_all(outputs_ / name);
    }
  }
}

}  // namespace
}  // namespace fovea::test
