#include "fovea/texture/atlas_warp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>

#include "fovea/base/random.h"
#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// Grey, but for noise in the middle.
Image8 busy_in_the_middle(int size) {
  Image8 image(size, size, 3, ColorEncoding::srgb);
  Random random(5);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const bool busy = std::abs(x - size / 2) < size / 6 && std::abs(y - size / 2) < size / 6;
      const bool bright = (x / 8 + y / 8) % 2 == 0;
      for (int k = 0; k < 3; ++k)
        image.at(x, y)[k] =
            static_cast<std::uint8_t>(busy ? (bright ? 200 : 60) + 20 * random.uniform() : 128);
    }
  }
  return image;
}

AtlasWarp warp(const Model& model, const Image8& image, int size, WarpAim aim = WarpAim::balanced,
               bool measured = true, int threads = 1) {
  Context context;
  context.threads = threads;
  const WarpedImage wanted{&image, {TexelMeaning::Kind::color}, size, size};
  return warp_atlas(model, find_atlases(model).at(0), {&wanted, 1}, {}, aim, {}, measured, context);
}

TEST(WarpAtlas, GivesTexelsToDetail) {
  const Model model = test::textured(test::grid(24, 24), 1);
  const AtlasWarp found = warp(model, busy_in_the_middle(192), 48);
  EXPECT_TRUE(found.is_moved);
  // What is busy is a ninth of the image; with half as many texels again along a side it would lose less than
  // half.
  EXPECT_LT(found.loss, 0.5 * found.plain_loss);
  EXPECT_EQ(found.images.at(0).width, 48);
  check(found.model.meshes[0].surface);
  const auto area = [](const AtlasFace& f) { return cross(f.uv[1] - f.uv[0], f.uv[2] - f.uv[0]); };
  const auto before = atlas_faces(model, find_atlases(model)[0]);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_GT(area(found.to[i]) * area(before[i]), 0);
}

TEST(WarpAtlas, StaysWhereThereIsNothingToGain) {
  const Model model = test::textured(test::grid(4, 4), 1);
  Image8 even(64, 64, 3, ColorEncoding::srgb);
  std::ranges::fill(even.pixels, std::uint8_t{77});
  const AtlasWarp found = warp(model, even, 16);
  EXPECT_FALSE(found.is_moved);
  EXPECT_EQ(found.images.at(0).width, 16);
  EXPECT_EQ(found.images.at(0).pixels[0], 77);
}

TEST(WarpAtlas, NeverLosesMoreThanPlainResizing) {
  Random random(9);
  Image8 noise(96, 96, 3, ColorEncoding::srgb);
  for (std::uint8_t& x : noise.pixels) x = static_cast<std::uint8_t>(255 * random.uniform());
  for (const int columns : {1, 3, 16}) {
    const Model model = test::textured(test::grid(columns, columns), 1);
    const AtlasWarp found = warp(model, noise, 24);
    EXPECT_LE(found.loss, found.plain_loss);
  }
}

TEST(WarpAtlas, LargeTrianglesGoOnlyAsFarAsTheyDoNotCoverOthers) {
  // Two triangles cannot bend: whatever the grid does between their corners, they show what they showed.
  const Model model = test::textured(test::grid(1, 1), 1);
  const AtlasWarp found = warp(model, busy_in_the_middle(96), 24, WarpAim::frequency, false);
  EXPECT_NEAR(found.loss, found.plain_loss, 0.1 * found.plain_loss);
}

TEST(WarpAtlas, ThreadsDoNotMatter) {
  const Model model = test::textured(test::grid(12, 12), 1);
  const Image8 image = busy_in_the_middle(96);
  const AtlasWarp one = warp(model, image, 24), three = warp(model, image, 24, WarpAim::balanced, true, 3);
  EXPECT_EQ(one.loss, three.loss);
  EXPECT_EQ(one.images.at(0).pixels, three.images.at(0).pixels);
  EXPECT_EQ(one.model.meshes[0].surface.layers[0].values, three.model.meshes[0].surface.layers[0].values);
}

/// Warps that lose so much in trials, of floors from a hundredth on; bakes of some losses are refused.
struct Fakes {
  std::vector<std::optional<double>> losses;
  std::set<double> refused;
  std::vector<double> tried, baked;

  std::optional<AtlasWarp> found(std::optional<double> plain_loss) {
    const WarpTrial trial{[this](double floor) -> std::optional<AtlasWarp> {
                            const std::optional<double> loss = losses.at(tried.size());
                            tried.push_back(floor);
                            if (!loss) return std::nullopt;
                            AtlasWarp warp;
                            warp.loss = *loss;
                            return warp;
                          },
                          [this](AtlasWarp& warp) {
                            baked.push_back(warp.loss);
                            return !refused.contains(warp.loss);
                          }};
    return find_warp(trial, 0.01, plain_loss);
  }
};

TEST(FindWarp, TakesTheFirstThatIsClearlyBetter) {
  Fakes fakes{{2.0, 1.2, 0.8, 0.1}, {}, {}, {}};
  EXPECT_EQ(fakes.found(1.0)->floor, 0.04);
  EXPECT_EQ(fakes.tried.size(), 3u);
}

TEST(FindWarp, ElseTheOneThatLosesLeast) {
  Fakes fakes{{0.99, 0.95, std::nullopt, 0.97, 1.1}, {}, {}, {}};
  EXPECT_EQ(fakes.found(1.0)->loss, 0.95);
  EXPECT_EQ(fakes.tried.size(), 5u);
}

TEST(FindWarp, GoesOnWithLessAmbitionIfABakeIsRefused) {
  Fakes fakes{{0.5, 0.6, 0.95, 0.92, 0.91}, {0.5, 0.6}, {}, {}};
  EXPECT_EQ(fakes.found(1.0)->loss, 0.91);
  EXPECT_EQ(fakes.baked, (std::vector{0.5, 0.6, 0.91}));
  Fakes hopeless{{0.5, 1.5, 1.5, 1.5, 1.5}, {0.5}, {}, {}};
  EXPECT_FALSE(hopeless.found(1.0));
  EXPECT_EQ(hopeless.tried.size(), 5u);
}

TEST(FindWarp, WithoutALossToBeatAnyWillDo) {
  Fakes fakes{{std::nullopt, 7.0, 1.0}, {}, {}, {}};
  EXPECT_EQ(fakes.found(std::nullopt)->loss, 7.0);
}

}  // namespace
}  // namespace fovea
