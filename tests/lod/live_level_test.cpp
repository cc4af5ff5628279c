#include "fovea/lod/live_level.h"

#include <gtest/gtest.h>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "lod/leveled.h"
#include "support/corner_soup.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using test::Leveled;
using test::leveled;
using test::random_cut;

/// The triangles of a live mesh that are there, as a mesh.
TriMesh snapshot(const LiveLevel& live, const TriMesh& source) {
  TriMesh mesh = live.mesh(0);
  std::vector<VertexId> number(mesh.vertex_count());
  TriMesh out;
  out.parts = source.parts;
  out.layers = mesh.layers;
  out.position_morphs = mesh.position_morphs;
  out.positions = mesh.positions;
  for (AttributeLayer& layer : out.layers) layer.corner_value.clear();
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!live.is_there(0, FaceId{f})) continue;
    out.triangles.push_back(mesh.triangles[f]);
    out.face_part.push_back(mesh.face_part[f]);
    for (std::size_t l = 0; l < out.layers.size(); ++l) {
      for (std::size_t k = 0; k < 3; ++k)
        out.layers[l].corner_value.push_back(mesh.layers[l].corner_value[3 * f + k]);
    }
  }
  return out;
}

TEST(LiveLevel, GoesToAnyCutFromAnyOther) {
  for (const auto& [name, mesh] : test::all_families()) {
    const Leveled model = leveled(test::model_of(mesh), 0);
    LiveLevel live(model.original, model.levels);
    EXPECT_EQ(live.triangle_count(), mesh.face_count()) << name;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const Cut cut = random_cut(model.levels, seed);
      live.go_to(cut);
      const TriMesh level = level_of(model.original, model.levels, cut).meshes[0].surface;
      EXPECT_EQ(live.triangle_count(), level.face_count()) << name;
      EXPECT_EQ(test::corner_soup(snapshot(live, mesh)), test::corner_soup(level)) << name << " " << seed;
    }
    live.go_to(Cut(model.levels.step_count(), 0));
    EXPECT_EQ(test::corner_soup(live.mesh(0)), test::corner_soup(mesh)) << name;
  }
}

TEST(LiveLevel, OtherLevelsAreRefused) {
  const Leveled model = leveled(test::model_of(test::torus(24, 12)), 60);
  EXPECT_THROW(LiveLevel(test::model_of(test::grid(3, 3)), model.levels), Error);
  LiveLevel live(model.original, model.levels);
  EXPECT_THROW(live.go_to(Cut(3, 0)), Error);
}

}  // namespace
}  // namespace fovea
