#include "fovea/io/off_read.h"

#include <gtest/gtest.h>

#include "support/reading.h"

namespace fovea {
namespace {

using test::bytes_of;
using test::expect_error;
using test::told;

void expect_off_refused(const std::string& text, ErrorKind kind, const std::string& place) {
  Context context;
  expect_error([&] { read_off(bytes_of(text), "test.off", {}, context); }, kind, place);
}

TEST(OffRead, CountsOnTheFirstLineOrTheNext) {
  for (const char* head : {"OFF 4 2 0\n", "OFF\n4 2 0\n", "# remark\nOFF # more\n\n4 2\n"}) {
    Context context;
    const std::string file =
        std::string(head) + "0 0 0\n1 0 0\n# between\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n2 0 1\n";
    const Model model = read_off(bytes_of(file), "test.off", {}, context);
    const TriMesh& mesh = model.meshes.at(0).surface;
    EXPECT_EQ(mesh.face_count(), 2u);
    EXPECT_EQ(mesh.source_vertex.size(), 4u);
    EXPECT_EQ(told(context, "small-faces"), 1u);
  }
}

TEST(OffRead, ColoursAndNormals) {
  Context context;
  const Model model = read_off(bytes_of("CNOFF\n3 1 0\n0 0 0 0 0 2 255 0 0 255\n1 0 0 0 0 2 255 0 0 255\n"
                                        "0 1 0 0 0 2 255 0 255 255\n3 0 1 2\n"),
                               "test.off", {}, context);
  const TriMesh& mesh = model.meshes.at(0).surface;
  EXPECT_EQ(mesh.find(Semantic::normal)->values, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh.find(Semantic::color)->values, (std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 1}));
}

TEST(OffRead, DamagedFilesAreRefusedWithThePlace) {
  expect_off_refused("OFF\n", ErrorKind::format, "test.off: line 2");
  expect_off_refused("OFF\n4000000000 1 0\n0 0 0\n", ErrorKind::format, "test.off: line 3");
  expect_off_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ErrorKind::format, "test.off: line 6");
  expect_off_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999999999 0 1 2\n", ErrorKind::format,
                     "test.off: line 6");
  expect_off_refused("OFF\n3 1 0\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", ErrorKind::format, "test.off: line 4");
  expect_off_refused("OFF BINARY\n", ErrorKind::unsupported, "test.off");
  expect_off_refused("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", ErrorKind::unsupported, "test.off");
}

TEST(OffRead, Comments) {
  const auto path = test::corpus_file("conformance/generated/comments.off");
  if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
  Context context;
  const Model model = read_model(*path, {}, context);
  EXPECT_EQ(counts(model).triangles, 4u);
  EXPECT_EQ(counts(model).vertices, 4u);
}

}  // namespace
}  // namespace fovea
