#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/io/field_file.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "run_command.h"
#include "support/meshes.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;

class FocusVerb : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }
  Model model(const std::string& path) const {
    Context context;
    return read_model(path, {}, context);
  }
  std::string write(const Model& model, const std::string& name) const {
    Context context;
    write_model(model, out(name), {}, context);
    return out(name);
  }
  Outcome focus(std::vector<std::string> words) const {
    words.insert(words.begin(), {"focus", sphere_});
    return fovea(words);
  }
  /// Triangles of the model on the side of +z that is nearer than this to the axis, and all others.
  static std::pair<int, int> split(const Model& model, float radius) {
    int inside = 0, outside = 0;
    const TriMesh& mesh = model.meshes[0].surface;
    for (const auto& t : mesh.triangles) {
      bool near = true;
      for (const VertexId v : t) {
        const Vec3f p = mesh.positions[v.index()];
        near &= p.z > 0 && std::hypot(p.x, p.y) < radius;
      }
      ++(near ? inside : outside);
    }
    return {inside, outside};
  }

  Folder folder_;
  std::string sphere_ = write(model_of(shuffled(icosphere(5))), "sphere.glb");  // 20,480 triangles
};

TEST_F(FocusVerb, KeepsWhatIsLookedAt) {
  // From the front the middle of the picture shows +z; 320 fifths of a pixel are a quarter of its width.
  const Outcome outcome = focus({"-o", out("o.glb"), "--at", "128,128", "--threshold", "320", "--factor", "0",
                                 "--error", "0.02", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto [inside, outside] = split(model(out("o.glb")), 0.4f);
  const auto [all_inside, all_outside] = split(model(sphere_), 0.4f);
  EXPECT_EQ(inside, all_inside);
  EXPECT_LT(outside, all_outside / 2);
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["verb"], "focus");
  EXPECT_EQ(json["result"]["triangles"], json["after"]["triangles"]);
  EXPECT_NEAR(json["result"]["error_rel"].get<double>(), 0.02, 1e-6);
  EXPECT_GT(json["triangles_attended"].get<int>(), all_inside);
}

TEST_F(FocusVerb, LargerThresholdsKeepMore) {
  std::uint64_t last = 0;
  for (const char* threshold : {"60", "120", "200", "265"}) {
    const Outcome outcome = focus({"-o", out("o.glb"), "--force", "--at", "128,128", "--threshold", threshold,
                                   "--factor", "0", "--error", "0.02", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::uint64_t triangles = outcome.json()["after"]["triangles"];
    EXPECT_GT(triangles, last) << threshold;
    last = triangles;
  }
}

TEST_F(FocusVerb, MeetsACountOfTriangles) {
  const Outcome outcome = focus({"-o", out("o.glb"), "--at", "100,100", "--ratio", "0.1", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LE(outcome.json()["after"]["triangles"].get<int>(), 2048);
  EXPECT_GE(outcome.json()["after"]["triangles"].get<int>(), 1900);
}

TEST_F(FocusVerb, SaysWhenMoreHadToStay) {
  const std::vector<std::string> words{"-o",     out("o.glb"), "--at", "128,128",     "--threshold",
                                       "100000", "--factor",   "0",    "--triangles", "100"};
  const Outcome outcome = focus(words);
  EXPECT_EQ(outcome.code, 8) << outcome.err;
  std::vector<std::string> allowed = words;
  allowed.insert(allowed.end(), {"--allow-miss", "--force"});
  EXPECT_EQ(focus(allowed).code, 0);
}

TEST_F(FocusVerb, WritesImportanceForOtherVerbs) {
  ASSERT_EQ(focus({"-o", out("i.npy"), "--at", "128,128", "--threshold", "200", "--factor", "0.5"}).code, 0);
  const std::vector<float> importance = read_field(out("i.npy"));
  ASSERT_FALSE(importance.empty());
  for (const float x : importance) EXPECT_TRUE(x == 1 || x == 4) << x;
  ASSERT_EQ(focus({"-o", out("lock.npy"), "--at", "128,128", "--threshold", "200", "--factor", "0"}).code, 0);
  const Outcome simplified = fovea({"simplify", sphere_, "-o", out("s.glb"), "--ratio", "0.1", "--importance",
                                    out("lock.npy"), "--metric", "quadric"});
  ASSERT_EQ(simplified.code, 0) << simplified.err;
  EXPECT_EQ(split(model(out("s.glb")), 0.2f).first, split(model(sphere_), 0.2f).first);
}

TEST_F(FocusVerb, WritesMarksAndPictures) {
  for (const std::string kind : {"heat", "attribute"}) {
    const Outcome outcome =
        focus({"-o", out(kind + ".glb"), "--at", "128,128", "--as", kind, "--factor", "0"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(model(out(kind + ".glb")).meshes[0].surface.face_count(), 20480u);
  }
  ASSERT_EQ(focus({"-o", out("p.png"), "--at", "128,128", "--error", "0.05"}).code, 0);
}

TEST_F(FocusVerb, KeepsWhatIsInARegion) {
  // The cap of the unit sphere above z = 0.8, by a ball and by a box around it.
  const auto cap = [](const Model& model) {
    int count = 0;
    const TriMesh& mesh = model.meshes[0].surface;
    for (const auto& t : mesh.triangles)
      count +=
          std::all_of(t.begin(), t.end(), [&](VertexId v) { return mesh.positions[v.index()].z > 0.8f; });
    return count;
  };
  const int all = cap(model(sphere_));
  ASSERT_GT(all, 1000);
  for (const auto& [option, value] :
       {std::pair("--sphere", "0,0,1,0.65"), std::pair("--box", "-1,-1,2,1,1,0.8")}) {
    const Outcome outcome =
        focus({"-o", out("o.glb"), "--force", option, value, "--factor", "0", "--error", "0.02", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(cap(model(out("o.glb"))), all) << option;
    EXPECT_LT(outcome.json()["result"]["triangles"], 20480 / 4) << option;
  }
}

TEST_F(FocusVerb, LooksFromWhereItIsTold) {
  const auto picture = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"-o", out("p.csv"), "--force", "--at", "128,128", "--json"});
    const Outcome outcome = focus(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.json()["view"]["toward"].get<std::vector<double>>();
  };
  const auto expect_near = [](const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5);
  };
  expect_near(picture({}), {0, 0, -1});
  expect_near(picture({"--view", "90,0"}), {-1, 0, 0});
  expect_near(picture({"--view=180,30"}), {0, -0.5, std::sqrt(0.75)});
  expect_near(picture({"--eye", "0,5,0"}), {0, -1, 0});
  expect_near(picture({"--eye", "3,0,4", "--target", "3,0,0"}), {0, 0, -1});
}

TEST_F(FocusVerb, RefusesWhatItCannotDo) {
  const auto expect = [&](std::vector<std::string> words, const std::string& text) {
    words.insert(words.end(), {"-o", out("no.glb")});
    const Outcome outcome = focus(words);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(text));
  };
  expect({"--error", "0.1"}, "--at 128,128");
  expect({"--at", "1", "--error", "0.1"}, "'1' is not a value");
  expect({"--at", "1,x", "--error", "0.1"}, "'1,x' is not a value");
  expect({"--at", "300,1", "--error", "0.1"}, "not in the picture");
  expect({"--at", "1,1"}, "no target");
  expect({"--at", "1,1", "--error", "0.1", "--ratio", "0.1"}, "more than one target");
  expect({"--at", "1,1", "--error", "0.1", "--view", "1,1", "--eye", "1,1,1"}, "give one of them");
  expect({"--at", "1,1", "--error", "0.1", "--law", "acuity", "--factor", "0"}, "--factor");
  expect({"--at", "1,1", "--error", "0.1", "--on-surface"}, "no surface");
  expect({"--at", "1,1", "--error", "0.1", "--eye", "1,2,3", "--target", "1,2,3"}, "where it looks at");
  expect({"--at", "1,1", "--error", "0.1", "--target", "1,1,1"}, "--target needs --eye");
  expect({"--sphere", "0,0,9,1", "--error", "0.1"}, "the model lies from -1");
  expect({"--sphere", "0,0,1,0", "--error", "0.1"}, "larger than 0");
  expect({"--box", "0,0,1", "--error", "0.1"}, "'0,0,1' is not a value");
  expect({"--sphere", "0,0,1,1", "--error", "0.1", "--on-surface"}, "--on-surface needs --at");
  const Outcome camera = focus({"-o", out("no.glb"), "--at", "1,1", "--error", "0.1", "--camera", "Front"});
  EXPECT_EQ(camera.code, 5) << camera.err;
  EXPECT_THAT(camera.err, HasSubstr("no camera"));
}

}  // namespace
}  // namespace fovea::test
