#include "fovea/saliency/people_data.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/io/field_file.h"
#include "fovea/io/read.h"
#include "fovea/surface/scene_surface.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::expect_error;
using test::TempFolder;
using Values = std::vector<float>;
using Over = PeopleMap::Over;

/// A square of two triangles, of areas ½ and 1½: (0 0) (1 0) (1 1) and (0 0) (1 1) (-2 1).
constexpr const char* kOff = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n-2 1 0\n3 0 1 2\n3 0 2 3\n";

/// A folder with one model and one map, and what comes of them.
class Pair {
 public:
  Pair(const std::string& model, const std::string& map, const std::string& model_name = "a.off",
       const std::string& map_name = "a.txt")
      : files_{"a", folder_.add(model_name, model), folder_.add(map_name, map)} {
    Context context;
    model_ = read_model(files_.model, {}, context);
  }
  const Model& model() const { return model_; }
  PeopleMap read() const { return read_people_map(files_, model_); }
  void refused(ErrorKind kind, const std::string& place, const std::string& message) const {
    expect_error([&] { read(); }, kind, place, message);
  }

 private:
  TempFolder folder_;
  PeopleFiles files_;
  Model model_;
};

std::vector<std::string> names_in(const TempFolder& folder) {
  std::vector<std::string> names;
  for (const PeopleFiles& files : find_people_files(folder.path())) {
    names.push_back(fmt::format("{}: {} {}", files.name,
                                files.model.lexically_relative(folder.path()).string(),
                                files.map.lexically_relative(folder.path()).string()));
  }
  return names;
}

TEST(PeopleData, FindsPairsBesideEachOtherAndInOtherFolders) {
  TempFolder folder;
  for (const char* name :
       {"bunny.obj", "bunny.npy", "Meshes/12.OFF", "Distributions/12.val", "Meshes/13.off", "deep/a/Arm.glb",
        "deep/b/c/arm.CSV", "readme.txt", "bunny.png", "x/cup.ply", "x/cup.txt", "y/cup.ply", "y/cup.txt"})
    folder.add(name, "");
  EXPECT_EQ(names_in(folder),
            (std::vector<std::string>{"12: Meshes/12.OFF Distributions/12.val",
                                      "Arm: deep/a/Arm.glb deep/b/c/arm.CSV", "bunny: bunny.obj bunny.npy",
                                      "cup: x/cup.ply x/cup.txt", "cup: y/cup.ply y/cup.txt"}));
}

TEST(PeopleData, PairsMustBePlain) {
  const auto refused = [](const std::vector<std::string>& names, ErrorKind kind, const std::string& place,
                          const std::string& message) {
    TempFolder folder;
    for (const std::string& name : names) folder.add(name, "");
    expect_error([&] { find_people_files(folder.path()); }, kind, place, message);
  };
  refused({"a.obj", "b.txt", "c.png"}, ErrorKind::input, "", "no model in it has a map");
  refused({"a.obj", "a.txt", "a.npy"}, ErrorKind::usage, "a.obj", "two maps");
  refused({"m/a.obj", "textured/a.txt", "plain/a.txt"}, ErrorKind::usage, "m/a.obj", "plain/a.txt");
  refused({"a.obj", "a.off", "a.txt"}, ErrorKind::usage, "a.txt", "two models");
  expect_error([] { find_people_files("/no/such/folder"); }, ErrorKind::input, "/no/such/folder");
}

TEST(PeopleData, OneValuePerVertexOfTheFile) {
  const PeopleMap map = Pair(kOff, "1\n2\n3.5\n0\n").read();
  EXPECT_EQ(map.over, Over::vertices);
  EXPECT_EQ(map.values, (Values{1, 2, 3.5f, 0}));
  EXPECT_EQ(map.points, 0u);
  // Vertices 1 and 4 are one point; the larger value counts. As many values as there are points will do too.
  const std::string twice = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -2 1 0\nv 1 0 0\nf 1 2 3\nf 5 4 3\n";
  EXPECT_EQ(Pair(twice, "1\n2\n3\n4\n5\n", "a.obj").read().values, (Values{1, 5, 3, 4}));
  EXPECT_EQ(Pair(twice, "1\n2\n3\n4\n", "a.obj").read().values, (Values{1, 2, 3, 4}));
}

TEST(PeopleData, OneValuePerFace) {
  const PeopleMap map = Pair(kOff, "0.25\n7\n").read();
  EXPECT_EQ(map.over, Over::faces);
  EXPECT_EQ(map.values, (Values{0.25f, 7}));
}

TEST(PeopleData, FacesOfAnObjKeepTheFilesOrder) {
  // Two materials by turns; the third and fourth face have no area, one by index and one by place; the last
  // is given twice.
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -2 1 0\nv 1 0 0\nv 9 9 9\nvt 0 0\nvn 0 0 1\n"
      "usemtl a\nf 1 2 3\nusemtl b\nf 1/1/1 3/1/1 4/1/1 # remark\nusemtl a\nf 1 2 2\nf 1 2 5\n"
      "f -4 -3 \\\n -5\nusemtl b\nf 1//1 2//1 4//1\nusemtl a\nf 1 2 3\n";
  const Pair pair(obj, "10\n20\n30\n40\n50\n60\n70\n", "a.obj");
  const PeopleMap map = pair.read();
  EXPECT_EQ(map.over, Over::faces);
  const TriMesh& mesh = pair.model().meshes[0].surface;
  ASSERT_EQ(map.values.size(), 5u);
  const auto value_of = [&](Vec3f a, Vec3f b, Vec3f c, int nth = 0) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const auto at = [&](std::size_t k) { return mesh.positions[mesh.triangles[f][k].index()]; };
      if (at(0) == a && at(1) == b && at(2) == c && nth-- == 0) return map.values[f];
    }
    return -1.0f;
  };
  const Vec3f o{0, 0, 0}, x{1, 0, 0}, xy{1, 1, 0}, far{-2, 1, 0};
  EXPECT_EQ(value_of(o, x, xy), 10);
  EXPECT_EQ(value_of(o, xy, far), 20);
  EXPECT_EQ(value_of(xy, far, x), 50);
  EXPECT_EQ(value_of(o, x, far), 60);
  EXPECT_EQ(value_of(o, x, xy, 1), 70);
}

TEST(PeopleData, FacesThatCannotBeToldAreRefused) {
  Pair(kOff, "1\n2\n3\n").refused(ErrorKind::format, "a.txt", "3 values fit neither 4 vertices");
  // A dropped triangle: three in the file, two left.
  std::string off = kOff;
  off.replace(off.find("4 2 0"), 5, "4 3 0");
  Pair(off + "3 1 1 2\n", "1\n2\n3\n").refused(ErrorKind::format, "a.txt", "nor 2 triangles");
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 2\nf 1 2 3 4\n";
  Pair(square, "1\n", "a.obj").refused(ErrorKind::unsupported, "a.obj: line 6", "4 corners");
  const std::string ply =
      "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\nelement vertex 4\n"
      "property float x\nproperty float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_indices\nproperty int texnumber\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n-2 1 0\n3 0 1 2 1\n3 0 2 3 0\n";
  Pair(ply, "1\n2\n", "a.ply").refused(ErrorKind::unsupported, "a.ply", "several materials");
}

TEST(PeopleData, ValuesMustBeNumbersFromZeroOn) {
  Pair(kOff, "1\n-2\n3\n4\n").refused(ErrorKind::format, "a.txt", "value 1");
  Pair(kOff, "1\nnan\n3\n4\n").refused(ErrorKind::format, "a.txt", "value 1");
  Pair(kOff, "1\ntwo\n3\n4\n").refused(ErrorKind::format, "a.txt: line 2", "");
}

TEST(PeopleData, PointsGoToTheirVertices) {
  // The diagonal is √10; the second point lies 2e-5 off, the third 2e-4; the vertex (1 1) has two.
  const std::string points =
      "1 1 0 0 0 1 2.5 1\n1 1 0.00002 0 0 1 4 1\n0 0.0002 0 0 0 1 9 1\n\n1,0,0, 0,0,1, 0.5,0\n";
  for (const char* heading : {"", "x y z nx ny nz seconds binary\n", "# points\n"}) {
    const PeopleMap map = Pair(kOff, heading + points).read();
    EXPECT_EQ(map.over, Over::vertices);
    EXPECT_EQ(map.values, (Values{0, 0.5f, 4, 0}));
    EXPECT_EQ(map.points, 4u);
    EXPECT_EQ(map.strays, 1u);
  }
}

TEST(PeopleData, PointsGoToTheNearestOfSeveral) {
  // Two vertices closer to each other than the tolerance.
  const std::string off = "OFF\n4 2 0\n0 0 0\n1000 0 0\n0 1000 0\n0.004 0 0\n3 0 1 2\n3 3 1 2\n";
  const PeopleMap map = Pair(off, "0.003 0 0 0 0 1 5 1\n0.001 0 0 0 0 1 3 1\n").read();
  EXPECT_EQ(map.values, (Values{3, 0, 0, 5}));
}

TEST(PeopleData, EveryVertexIsFoundAmongMany) {
  const TriMesh mesh = test::icosphere(4);
  std::string off = fmt::format("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.face_count());
  std::string points;
  Values expected;
  for (const Vec3f& p : mesh.positions) off += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  for (const auto& t : mesh.triangles) off += fmt::format("3 {} {} {}\n", t[0].value, t[1].value, t[2].value);
  for (std::size_t v = mesh.vertex_count(); v-- > 0;) {
    const Vec3f p = mesh.positions[v];
    points += fmt::format("{:.5f} {:.5f} {:.5f} 0 0 2 {} 0\n", p.x, p.y, p.z, v);
    expected.insert(expected.begin(), static_cast<float>(v));
  }
  const PeopleMap map = Pair(off, points).read();
  EXPECT_EQ(map.strays, 0u);
  EXPECT_EQ(map.values, expected);
}

TEST(PeopleData, BadPointsAreRefused) {
  const std::string good = "1 1 0 0 0 1 2.5 1\n";
  Pair(kOff, good + "1 1 0 0 0 1 2.5\n").refused(ErrorKind::format, "a.txt: line 2", "no point");
  Pair(kOff, good + "1 1 0 0 0 1 2.5 1 7\n").refused(ErrorKind::format, "a.txt: line 2", "no point");
  Pair(kOff, good + "1 1 0 0 0 1 nan 1\n").refused(ErrorKind::format, "a.txt: line 2", "no point");
  Pair(kOff, good + "1 1 0 0 0 1 1e300 1\n").refused(ErrorKind::format, "a.txt: line 2", "no point");
  Pair(kOff, "8 8 8 0 0 1 2 1\n1e30 0 0 0 0 1 2 1\n")
      .refused(ErrorKind::format, "a.txt", "none of 2 points is at a vertex");
}

TEST(PeopleData, PredictionsAreHeldAgainstVerticesOrFaces) {
  const Pair pair(kOff, "0\n1\n2\n5\n"), faces(kOff, "3\n1\n");
  const Model read = pair.model();
  const Surface surface = scene_surface(read, rest_pose(read)).surface;
  const VertexField predicted(Values{3, 0, 3, 9});
  const Agreement by_vertex = agreement(predicted, pair.read(), surface, {}),
                  by_vertex_expected = agreement(Values{3, 0, 3, 9}, Values{0, 1, 2, 5}, Values{4, 1, 4, 3});
  EXPECT_NEAR(by_vertex.correlation, by_vertex_expected.correlation, 1e-6);
  EXPECT_NEAR(by_vertex.auc, by_vertex_expected.auc, 1e-6);
  const Agreement by_face = agreement(predicted, faces.read(), surface, {}),
                  by_face_expected = agreement(Values{2, 5}, Values{3, 1}, Values{1, 3});
  EXPECT_NEAR(by_face.kl, by_face_expected.kl, 1e-6);
  EXPECT_NEAR(by_face.similarity, by_face_expected.similarity, 1e-6);
}

}  // namespace
}  // namespace fovea
