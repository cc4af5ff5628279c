#include "fovea/texture/felzenszwalb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/io/field_file.h"
#include "fovea/io/image_codec.h"
#include "oracle/segment_oracle.h"
#include "support/pictures.h"
#include "support/reading.h"

namespace fovea {
namespace {

using ::testing::ElementsAre;

using Labels = std::vector<std::uint32_t>;

SegmentOptions options(double sigma, double k, std::int64_t min_size) {
  SegmentOptions o;
  o.sigma = sigma;
  o.k = k;
  o.min_size = min_size;
  return o;
}

Labels graph(std::size_t nodes, const std::vector<WeightedEdge>& edges, double k, std::int64_t min_size = 0) {
  return segment_graph(nodes, edges, options(0, k, min_size), Context()).label;
}

LabelMap image_regions(const Image8& image, const SegmentOptions& o, int threads = 1) {
  Context context;
  context.threads = threads;
  return segment_image(image, o, context);
}

Image8 picture(int width, int height, int channels, const std::vector<int>& values) {
  Image8 image(width, height, channels, ColorEncoding::srgb);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<std::uint8_t>(values[i]);
  return image;
}

/// Noise of `levels` values from 0 to 255.
Image8 noise(int width, int height, int channels, std::uint32_t levels, std::uint64_t seed) {
  Image8 image(width, height, channels, ColorEncoding::srgb);
  Random random(seed);
  for (std::uint8_t& x : image.pixels)
    x = static_cast<std::uint8_t>(random.below(levels) * 255 / std::max(levels - 1, 1u));
  return image;
}

//   0 --1-- 1 --5-- 2 --1.25-- 3
//
// The outer edges join first: Int is 1 and 1.25, two nodes each. 5 joins them if it is less than 1 + k / 2.
TEST(SegmentGraph, APathByHand) {
  const std::vector<WeightedEdge> path{{1, 2, 5}, {0, 1, 1}, {3, 2, 1.25}};
  EXPECT_THAT(graph(4, path, 8), ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(graph(4, path, 8.01), ElementsAre(0, 0, 0, 0));
  // An edge joins single nodes if it is less than k.
  EXPECT_THAT(graph(4, path, 1.25), ElementsAre(0, 0, 1, 2));
  EXPECT_THAT(graph(4, path, 1), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(graph(4, path, 0), ElementsAre(0, 1, 2, 3));
  // The pairs have two nodes: fewer than 3, not fewer than 2.
  EXPECT_THAT(graph(4, path, 8, 2), ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(graph(4, path, 8, 3), ElementsAre(0, 0, 0, 0));
}

TEST(SegmentGraph, SmallComponentsJoinTheNearest) {
  //  0 --1-- 1 --9-- 2 --8-- 3 --1-- 4     Node 2 is alone for k = 4.
  EXPECT_THAT(graph(5, {{0, 1, 1}, {1, 2, 9}, {2, 3, 8}, {3, 4, 1}}, 4, 2), ElementsAre(0, 0, 1, 1, 1));
  EXPECT_THAT(graph(5, {{0, 1, 1}, {1, 2, 8}, {2, 3, 9}, {3, 4, 1}}, 4, 2), ElementsAre(0, 0, 0, 1, 1));
  // Of two as near, the edge that comes first in the list.
  EXPECT_THAT(graph(5, {{0, 1, 1}, {2, 3, 9}, {1, 2, 9}, {3, 4, 1}}, 4, 2), ElementsAre(0, 0, 1, 1, 1));
}

TEST(SegmentGraph, OddGraphs) {
  EXPECT_THAT(graph(0, {}, 1), ElementsAre());
  EXPECT_THAT(graph(3, {}, 1, 9), ElementsAre(0, 1, 2));
  EXPECT_THAT(graph(3, {{1, 1, 0}, {2, 0, -0.0f}, {0, 2, 0}}, 1), ElementsAre(0, 1, 0));
  // −0 is 0, and comes before what is more.
  EXPECT_THAT(graph(3, {{0, 1, 0.5f}, {1, 2, -0.0f}}, 0.6), ElementsAre(0, 1, 1));
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_THAT(graph(2, {{0, 1, infinity}}, 1e300), ElementsAre(0, 1));
  EXPECT_THAT(graph(2, {{0, 1, infinity}}, 1, 2), ElementsAre(0, 0));
}

TEST(SegmentGraph, RefusesWhatIsNoGraph) {
  for (const WeightedEdge& edge : {WeightedEdge{0, 2, 1}, {2, 0, 1}, {0, 1, -1}, {0, 1, std::nanf("")}})
    test::expect_error([&] { graph(2, {edge}, 1); }, ErrorKind::usage, "graph", "edge 0");
}

TEST(SegmentGraph, IsTheLiteralAlgorithm) {
  Random random(4);
  for (int n = 0; n < 60; ++n) {
    const std::uint32_t nodes = 1 + random.below(40);
    std::vector<WeightedEdge> edges;
    std::vector<test::PlainEdge> plain;
    for (std::uint32_t i = 0; i < 3 * nodes; ++i) {
      // Some graphs with many equal weights.
      const auto weight = static_cast<float>(n % 2 == 0 ? random.below(4) : random.below(1000)) / 8;
      edges.push_back({random.below(nodes), random.below(nodes), weight});
      plain.push_back({edges.back().a, edges.back().b, static_cast<double>(weight)});
    }
    const double k = random.uniform(0, 100);
    const std::uint32_t min_size = random.below(6);
    EXPECT_EQ(graph(nodes, edges, k, min_size), test::literal_segments(nodes, plain, k, min_size)) << n;
  }
}

TEST(SegmentImage, TwoHalvesByHand) {
  //  10 10 110 110     Four texels each; the border joins them if 100 < k / 4.
  //  10 10 110 110
  const Image8 image = picture(4, 2, 1, {10, 10, 110, 110, 10, 10, 110, 110});
  const LabelMap apart = image_regions(image, options(0, 400, 0));
  EXPECT_EQ(apart.width, 4);
  EXPECT_EQ(apart.height, 2);
  EXPECT_EQ(apart.count, 2u);
  EXPECT_THAT(apart.labels, ElementsAre(0, 0, 1, 1, 0, 0, 1, 1));
  EXPECT_EQ(image_regions(image, options(0, 401, 0)).count, 1u);
  EXPECT_EQ(image_regions(image, options(0, 400, 4)).count, 2u);
  EXPECT_EQ(image_regions(image, options(0, 400, 5)).count, 1u);
}

TEST(SegmentImage, DiagonalsConnect) {
  //  0 9 0
  //  9 0 9     Nines and noughts each hang together by diagonals alone.
  const Image8 image = picture(3, 2, 1, {0, 255, 0, 255, 0, 255});
  EXPECT_THAT(image_regions(image, options(0, 1, 0)).labels, ElementsAre(0, 1, 0, 1, 0, 1));
}

TEST(SegmentImage, ColorsAreAsFarApartAsTheyAreInSpace) {
  // 3 in red and 4 in green are 5: the distance is less than k = 5.01, not less than 5.
  const Image8 image = picture(2, 1, 3, {10, 10, 10, 13, 14, 10});
  EXPECT_EQ(image_regions(image, options(0, 5, 0)).count, 2u);
  EXPECT_EQ(image_regions(image, options(0, 5.01, 0)).count, 1u);
  // Grey is one number, in one channel; alpha does not count.
  EXPECT_EQ(image_regions(picture(2, 1, 2, {10, 0, 15, 255}), options(0, 5, 0)).count, 2u);
  EXPECT_EQ(image_regions(picture(2, 1, 2, {10, 0, 15, 255}), options(0, 5.01, 0)).count, 1u);
  EXPECT_EQ(image_regions(picture(2, 1, 4, {10, 10, 10, 0, 10, 10, 10, 255}), options(0, 0.01, 0)).count, 1u);
}

TEST(SegmentImage, IsTheLiteralAlgorithm) {
  constexpr std::array<std::array<int, 2>, 8> kSizes{
      {{1, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 7}, {13, 8}, {16, 17}, {24, 18}}};
  std::uint64_t seed = 0;
  for (const auto& [width, height] : kSizes) {
    for (const double sigma : {0.0, 0.5, 0.8, 2.3}) {
      for (const auto& [k, min_size] : {std::pair{1.0, 20}, {50.0, 0}, {300.0, 5}, {0.0, 3}}) {
        // Few levels give equal weights, which nothing but the order decides; smoothed ones differ by
        // rounding between two ways to add them up, so these images have many levels.
        const std::uint32_t levels = sigma > 0 ? 256 : 3;
        ++seed;
        const Image8 image = noise(width, height, 1 + static_cast<int>(seed % 4), levels, seed);
        EXPECT_EQ(image_regions(image, options(sigma, k, min_size)).labels,
                  test::literal_segments(image, options(sigma, k, min_size)))
            << width << " x " << height << ", sigma " << sigma << ", k " << k;
      }
    }
  }
}

// Regions that scikit-image 0.19.3 finds in three pictures: skimage.segmentation.felzenszwalb(image) with its
// defaults, scale 1, sigma 0.8, min_size 20; labels renumbered in scan order. Colour with noise; grey; flat
// areas with hard borders, whose many equal weights leave scikit-image's result the same in any order.
class SegmentFixture : public ::testing::TestWithParam<std::string> {};

TEST_P(SegmentFixture, RegionsAreThoseOfScikitImage) {
  const std::string stem = std::string(FOVEA_TEST_FIXTURES) + "/" + GetParam();
  std::ifstream file(stem + ".png", std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const Image8 image = decode_image(bytes);
  const std::vector<float> expected = read_npy(stem + ".npy");
  const LabelMap found = image_regions(image, options(0.8, 1, 20));
  EXPECT_GT(found.count, 5u);
  EXPECT_EQ(std::vector<float>(found.labels.begin(), found.labels.end()), expected);
}

INSTANTIATE_TEST_SUITE_P(, SegmentFixture, ::testing::Values("color", "grey", "flat"),
                         [](const auto& name) { return name.param; });

TEST(SegmentImage, EveryRegionHasTheLeastSize) {
  const LabelMap found = image_regions(noise(60, 50, 3, 256, 1), options(0.8, 100, 30));
  std::vector<int> size(found.count, 0);
  for (const std::uint32_t label : found.labels) ++size[label];
  EXPECT_GT(found.count, 3u);
  EXPECT_GE(*std::min_element(size.begin(), size.end()), 30);
}

TEST(SegmentImage, AConstantIsOneRegion) {
  for (const double sigma : {0.0, 0.8, 100.0})
    EXPECT_EQ(image_regions(noise(17, 5, 3, 1, 0), options(sigma, 1e-6, 0)).count, 1u);
}

TEST(SegmentImage, NothingHasNoRegions) {
  EXPECT_EQ(image_regions(Image8(), SegmentOptions{}).count, 0u);
  EXPECT_EQ(image_regions(Image8(0, 5, 3, ColorEncoding::srgb), SegmentOptions{}).count, 0u);
}

TEST(SegmentImage, LargeImagesAreReduced) {
  const Image8 image = test::pattern(64, 48);
  SegmentOptions o = options(0.8, 20, 4);
  o.most_texels = 64 * 48 - 1;
  const LabelMap found = image_regions(image, o);
  EXPECT_EQ(found.width, 32);
  EXPECT_EQ(found.height, 24);
  EXPECT_EQ(found.labels.size(), 32u * 24u);
}

TEST(SegmentImage, RefusesOptionsOutOfRange) {
  const Image8 image = noise(2, 2, 1, 2, 0);
  for (const SegmentOptions& o : {options(-1, 1, 0), options(101, 1, 0), options(0, -1, 0), options(0, 1, -1),
                                  options(std::nan(""), 1, 0), options(0, std::nan(""), 0)})
    test::expect_error([&] { image_regions(image, o); }, ErrorKind::usage, "");
}

TEST(SegmentImage, TheSameRegionsForAnyNumberOfThreads) {
  // 200,000 edges or more: several chunks of rows and of the sort.
  const Image8 image = test::distorted(test::pattern(300, 260));
  const LabelMap one = image_regions(image, SegmentOptions{}, 1),
                 three = image_regions(image, SegmentOptions{}, 3);
  EXPECT_GT(one.count, 10u);
  EXPECT_EQ(one.labels, three.labels);
}

}  // namespace
}  // namespace fovea
