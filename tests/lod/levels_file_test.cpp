#include "fovea/lod/levels_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/io/gltf_read.h"
#include "fovea/io/gltf_write.h"
#include "fovea/judge/surface_distance.h"
#include "fovea/lod/cut.h"
#include "fovea/surface/surface.h"
#include "lod/leveled.h"
#include "support/corner_soup.h"
#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

using test::Leveled;
using test::leveled;
using testing::HasSubstr;

std::vector<std::byte> encoded(const Leveled& leveled, const WriteOptions& options = {}) {
  Context context;
  return encode_levels(leveled, options, context);
}

Leveled decoded(std::span<const std::byte> bytes, const LevelsReadOptions& levels = {}) {
  Context context;
  return read_levels(bytes, "file", levels, {}, context);
}

/// The same without the steps that files leave out.
Leveled stored(Leveled model) {
  const Cut cut = cut_leaving_meshes(model.original, model.levels);
  model.levels.record.steps.resize(static_cast<std::size_t>(std::ranges::count(cut, 1)));
  return model;
}

std::vector<std::vector<std::string>> soup(const Leveled& model, const Cut& cut) {
  return test::corner_soup(level_of(model.original, model.levels, cut).meshes.at(0).surface);
}

Cut sparse_cut(const MultiTessellation& levels, std::uint64_t seed) {
  Random random(seed);
  Cut cut(levels.step_count(), 0);
  for (std::size_t s = 0; s < cut.size(); ++s) {
    const auto needs = levels.needs_of(s);
    cut[s] =
        random.uniform() < 0.9 && std::ranges::all_of(needs, [&](std::uint32_t n) { return cut[n] != 0; });
  }
  return cut;
}

/// A wavy sheet with a seam through it, of two parts.
TriMesh sheet() { return test::two_part_grid(12, 9); }

std::vector<test::NamedMesh> meshes() {
  std::vector<test::NamedMesh> list = test::all_families();
  std::erase_if(list, [](const test::NamedMesh& m) { return m.mesh.face_count() == 0; });
  list.push_back({"large torus", test::torus(40, 20)});
  list.push_back({"shuffled", test::shuffled(test::torus(24, 12))});
  return list;
}

TEST(LevelsFile, EveryLevelComesBack) {
  for (const auto& [name, mesh] : meshes()) {
    for (const Placement placement : {Placement::optimal, Placement::half_edge}) {
      const Leveled model = leveled(test::model_of(mesh), 0, 2, placement);
      const Leveled back = decoded(encoded(model));
      const std::size_t steps = stored(model).levels.step_count();
      ASSERT_EQ(back.levels.step_count(), steps) << name;
      EXPECT_EQ(back.levels.triangles, model.levels.triangles) << name;
      for (const double part : {0.0, 0.1, 0.5, 0.9, 1.0}) {
        const auto count = static_cast<std::size_t>(std::floor(part * static_cast<double>(steps)));
        Cut before(model.levels.step_count(), 0), after(steps, 0);
        std::fill_n(before.begin(), count, std::uint8_t{1});
        std::fill_n(after.begin(), count, std::uint8_t{1});
        EXPECT_EQ(soup(back, after), soup(model, before)) << name << " " << count << " steps";
      }
    }
  }
}

TEST(LevelsFile, StepsNeedTheSame) {
  for (const auto& [name, mesh] : meshes()) {
    const Leveled model = leveled(test::model_of(mesh), 0);
    const Leveled back = decoded(encoded(model));
    for (std::size_t s = 0; s < back.levels.step_count(); ++s)
      EXPECT_THAT(back.levels.needs_of(s), testing::ElementsAreArray(model.levels.needs_of(s))) << name;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      Cut cut = sparse_cut(back.levels, seed);
      const auto level = soup(back, cut);
      cut.resize(model.levels.step_count(), 0);
      EXPECT_EQ(level, soup(model, cut)) << name << " " << seed;
    }
  }
}

TEST(LevelsFile, ErrorsAreNoSmallerAndAtMostALittleLarger) {
  const Leveled model = leveled(test::model_of(test::torus(40, 20)), 0);
  const Leveled back = decoded(encoded(model));
  for (std::size_t s = 0; s < back.levels.step_count(); ++s) {
    EXPECT_GE(back.levels.error[s], model.levels.error[s]);
    EXPECT_LE(back.levels.error[s], model.levels.error[s] * (1 + 1.0f / 128));
    EXPECT_GE(back.levels.record.steps[s].error_rel, model.levels.record.steps[s].error_rel);
  }
}

TEST(LevelsFile, KeepsImagesSkinsAndMorphTargets) {
  const Leveled textured = leveled(test::textured(test::open_cylinder(24, 12), 2), 60);
  const Leveled back = decoded(encoded(textured));
  ASSERT_EQ(back.original.images.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(back.original.images[i].bytes, textured.original.images[i].bytes);
  EXPECT_EQ(soup(back, Cut(back.levels.step_count(), 0)),
            soup(textured, Cut(textured.levels.step_count(), 0)));

  const Leveled skinned = decoded(encoded(leveled(test::skinned_model(40), 20)));
  EXPECT_EQ(skinned.original.skins.size(), 1u);
  EXPECT_EQ(skinned.original.animations.size(), 1u);

  const Leveled morphed = leveled(test::model_of(test::morph_strip(30)), 10);
  const Leveled again = decoded(encoded(morphed));
  ASSERT_EQ(again.original.meshes[0].surface.target_count(), 2u);
  EXPECT_EQ(soup(again, Cut(again.levels.step_count(), 1)),
            soup(morphed, Cut(morphed.levels.step_count(), 1)));
}

TEST(LevelsFile, MeshesOfOneModelStayApart) {
  Model two = test::model_of({test::torus(16, 8), test::tetrahedron(), sheet()});
  const Leveled model = leveled(two, 0);
  const Leveled back = decoded(encoded(model));
  ASSERT_EQ(back.original.meshes.size(), 3u);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(test::corner_soup(back.original.meshes[m].surface), test::corner_soup(two.meshes[m].surface));
    // Not even the coarsest level has lost one.
    EXPECT_GT(coarsest(back).meshes[m].surface.face_count(), 0u);
  }
}

TEST(LevelsFile, AnyBeginningIsALevel) {
  const Leveled model = leveled(test::model_of(test::torus(240, 100)), 100);
  const std::vector<std::byte> bytes = encoded(model);
  EXPECT_THROW(decoded(std::span(bytes).first(bytes.size() / 2)), Error);
  std::uint64_t triangles = 0;
  for (const double part : {0.05, 0.3, 0.6, 1.0}) {
    const auto size = static_cast<std::size_t>(part * static_cast<double>(bytes.size()));
    const Leveled some = decoded(std::span(bytes).first(size), {.beginning = true});
    EXPECT_GE(some.levels.triangles, triangles);
    triangles = some.levels.triangles;
    const std::size_t left = some.levels.step_count();
    Cut cut(model.levels.step_count(), 0);
    std::fill_n(cut.begin(), model.levels.step_count() - left, std::uint8_t{1});
    EXPECT_EQ(soup(some, Cut(left, 0)), soup(model, cut)) << part;
  }
  EXPECT_EQ(triangles, 48'000u);
  // No more is read than is asked for.
  const Leveled enough = decoded(bytes, {.triangles = 5'000});
  EXPECT_GE(enough.levels.triangles, 5'000u);
  EXPECT_LT(enough.levels.triangles, 48'000u);
}

TEST(LevelsFile, QuantizedNumbersAreOnAGridWithinTheError) {
  const TriMesh mesh = test::icosphere(4);
  const Leveled model = leveled(test::model_of(mesh), 100);
  WriteOptions options;
  options.quantize = true;
  options.position_bits = 10;
  const std::vector<std::byte> bytes = encoded(model, options);
  EXPECT_LT(bytes.size(), encoded(model).size() * 2 / 3);
  const Leveled back = decoded(bytes);
  for (const Vec3f& p : back.original.meshes[0].surface.positions)
    EXPECT_EQ(p.x * 256, std::round(p.x * 256));  // 2 / 1023 or finer
  Context context;
  for (const double error : {0.01, 0.05}) {
    const Cut cut = cut_at_error(back.levels, error);
    const Surface level = surface_of(level_of(back.original, back.levels, cut).meshes[0].surface);
    EXPECT_LE(surface_distance(surface_of(mesh), level, 20'000, context).hausdorff(), error);
  }
}

TEST(LevelsFile, IntegersStayIntegers) {
  TriMesh mesh = test::wavy_grid(16, 16, 0.2);
  for (Vec3f& p : mesh.positions)
    p = {std::round(p.x * 4000), std::round(p.y * 4000), std::round(p.z * 4000)};
  mesh.position_storage = {ComponentType::i16, false};
  const Leveled back = decoded(encoded(leveled(test::model_of(mesh), 40)));
  for (const std::size_t steps : {std::size_t{0}, back.levels.step_count()}) {
    Cut cut(back.levels.step_count(), 0);
    std::fill_n(cut.begin(), steps, std::uint8_t{1});
    const Model level = level_of(back.original, back.levels, cut);
    for (const Vec3f& p : level.meshes[0].surface.positions) EXPECT_EQ(p.x, std::round(p.x));
  }
}

TEST(LevelsFile, OtherProgramsSeeTheCoarsestInAGlb) {
  const Leveled model = leveled(test::textured(test::torus(40, 20), 1), 100);
  Context context;
  const GltfOutput glb = write_gltf(with_levels(model, {}, context), true, "", {}, context);
  const Model read = read_gltf(glb.files[0].bytes, {}, "a.glb", {}, context);
  EXPECT_EQ(test::corner_soup(read.meshes[0].surface), test::corner_soup(coarsest(model).meshes[0].surface));
  const std::optional<LeveledModel> back = levels_inside(read, {}, {}, context);
  ASSERT_TRUE(back);
  EXPECT_EQ(test::corner_soup(back->original.meshes[0].surface),
            test::corner_soup(model.original.meshes[0].surface));
  // What is written of that has no levels inside.
  EXPECT_FALSE(levels_inside(back->original, {}, {}, context));
  EXPECT_EQ(back->original.json.find("FOVEA"), std::string::npos);
  EXPECT_TRUE(back->original.carried_buffer_views.empty());
  EXPECT_FALSE(levels_inside(model.original, {}, {}, context));
  EXPECT_THROW(with_levels({read, model.levels}, {}, context), Error);
}

TEST(LevelsFile, SameBytesForAnyNumberOfThreads) {
  const Model model = test::model_of(test::torus(40, 20));
  EXPECT_EQ(encoded(leveled(model, 50, 1)), encoded(leveled(model, 50, 4)));
}

std::string refused(std::span<const std::byte> bytes) {
  try {
    decoded(bytes);
  } catch (const Error& error) {
    EXPECT_NE(error.kind(), ErrorKind::internal) << error.what();
    return error.what();
  }
  return "";
}

TEST(LevelsFile, RefusesWhatIsNoneOrOfAnotherVersion) {
  EXPECT_THAT(refused({}), HasSubstr("no file of levels"));
  const std::string text = "glTF and more of it";
  EXPECT_THAT(refused(std::as_bytes(std::span(text))), HasSubstr("file: this is no file of levels"));
  std::vector<std::byte> bytes = encoded(leveled(test::model_of(test::cube()), 8));
  bytes[8] = std::byte{2};
  EXPECT_THAT(refused(bytes), HasSubstr("version 2, known is 1"));
}

TEST(LevelsFile, RefusesAnyBrokenByte) {
  const std::vector<std::byte> bytes = encoded(leveled(test::model_of(test::torus(12, 8)), 20));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::byte> broken = bytes;
    broken[i] ^= std::byte{0x10};
    EXPECT_NE(refused(broken), "") << "byte " << i;
    EXPECT_NE(refused(std::span(bytes).first(i)), "") << "ends at " << i;
  }
}

/// Files that nobody's checksum protects: anything may be in them.
TEST(LevelsFile, StandsWhatNoWriterWrites) {
  const std::vector<std::byte> bytes = encoded(leveled(test::textured(test::torus(12, 8), 1), 20));
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::byte> broken = bytes;
    // Each chunk without its checksum, and a few bytes of the last ones changed.
    std::size_t at = 10, base = 0;
    while (at + 12 <= broken.size()) {
      std::uint32_t size = 0;
      for (std::size_t k = 0; k < 4; ++k) size |= static_cast<std::uint32_t>(broken[at + 4 + k]) << (8 * k);
      std::fill_n(broken.begin() + static_cast<std::ptrdiff_t>(at) + 8, 4, std::byte{0});
      if (broken[at] == std::byte{'B'}) base = at + 12;
      at += 12 + size;
    }
    for (int k = 0; k < 3; ++k) {
      const auto place =
          base + static_cast<std::size_t>(random.uniform() * static_cast<double>(broken.size() - base));
      broken[place] = static_cast<std::byte>(random.uniform() * 256);
    }
    refused(broken);
  }
}

}  // namespace
}  // namespace fovea
