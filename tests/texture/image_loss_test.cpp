#include "fovea/texture/image_loss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

/// Every other row white, else black.
Image8 stripes(int size) {
  Image8 image = test::even(size, 0);
  for (int y = 0; y < size; y += 2)
    for (int x = 0; x < size; ++x) std::fill_n(image.at(x, y), 3, std::uint8_t{255});
  return image;
}

ImageUse colors() { return {.is_used = true, .meaning = {TexelMeaning::Kind::color}}; }

ImageSights sights_of(const Model& model, std::vector<double> pixels,
                      const std::vector<VertexField>& field = {}) {
  return {model, atlas_faces(model, find_atlases(model).at(0)), field, std::move(pixels)};
}

TEST(ImageLoss, IsTheSquaredDifferenceOfWhatIsShown) {
  const Model model = test::textured(test::grid(3, 3), 1);
  const ImageSights sights = sights_of(model, {64, 512});
  const ImageLoss loss(sights, test::even(16, 100), colors(), {});
  EXPECT_THAT(loss.of(test::even(16, 100), {}), testing::ElementsAre(0, 0));
  EXPECT_THAT(loss.of(test::even(4, 110), {}), Each(testing::DoubleNear(3 * std::pow(10.0 / 255, 2), 1e-6)));
}

TEST(ImageLoss, PicturesThatAreSmallSeeNoFineDetail) {
  // Light of half the rows: a grey of 188 where they are too small to be seen.
  const Model model = test::textured(test::grid(3, 3), 1);
  const ImageSights sights = sights_of(model, {16, 2048});
  const std::vector<double> lost = ImageLoss(sights, stripes(256), colors(), {}).of(test::even(256, 188), {});
  EXPECT_LT(lost[0], 0.001);
  EXPECT_GT(lost[1], 0.1);  // looks between rows see mixtures of them
}

TEST(ImageLoss, CountsWhereThereAreLooks) {
  // Only one half of the square is looked at, and only the other half of the image differs.
  const Model model = test::textured(test::grid(2, 2), 1);
  const TriMesh& mesh = model.meshes[0].surface;
  VertexField field(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    field[VertexId(static_cast<std::uint32_t>(v))] = mesh.positions[v].y > 0.6f ? 1.0f : 0.0f;
  const ImageSights sights = sights_of(model, {64}, {field}), all = sights_of(model, {64});
  Image8 upper = test::even(64, 50);
  std::fill_n(upper.at(0, 0), 64 * 16 * 3, std::uint8_t{200});
  const auto lost = [&](const ImageSights& seen) {
    return ImageLoss(seen, test::even(64, 50), colors(), {}).of(upper, {})[0];
  };
  EXPECT_GT(lost(all), 0);
  EXPECT_LT(lost(sights), lost(all) / 10);
}

TEST(ImageLoss, ImagesThatNoTriangleShowsAreSeenAsAWhole) {
  const Model model = test::textured(test::grid(2, 2), 1);
  const ImageSights sights(model, {}, {}, {256});
  EXPECT_THAT(sights.all(), SizeIs(8100));
  Image8 corner = test::even(64, 0);
  std::fill_n(corner.at(63, 63), 3, std::uint8_t{255});
  EXPECT_GT(ImageLoss(sights, test::even(64, 0), colors(), {}).of(corner, {})[0], 0);
}

TEST(ImageLoss, IsTheSameForAnyNumberOfThreads) {
  const Model model = test::textured(test::grid(3, 3), 1);
  const ImageSights sights = sights_of(model, {512});
  Context one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(ImageLoss(sights, stripes(64), colors(), one).of(test::even(64, 80), one),
            ImageLoss(sights, stripes(64), colors(), four).of(test::even(64, 80), four));
}

}  // namespace
}  // namespace fovea
