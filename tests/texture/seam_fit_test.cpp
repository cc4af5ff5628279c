#include "fovea/texture/seam_fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/io/image_codec.h"
#include "fovea/texture/atlas_raster.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/fill.h"
#include "fovea/texture/seam_jump.h"
#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

constexpr int kWholeSide = 320, kSmallerSide = 80;

/// A plane in small charts that gets lighter along x, the same on both sides of every seam, with black and
/// white between the charts.
struct Ramp {
  Model model = test::small_charts(kWholeSide);
  std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model).at(0));
  Image8 painted = decode_image(model.images[0].bytes);
  Image8 filled;
  Ramp() {
    const TriMesh& mesh = model.meshes[0].surface;
    const double width = bounds(model).high.x - bounds(model).low.x;
    std::vector<std::uint8_t> drawn(static_cast<std::size_t>(kWholeSide * kWholeSide), 0);
    for_atlas_texels(
        faces, kWholeSide, kWholeSide,
        [&](std::uint32_t face, const std::array<double, 3>& weights, std::size_t texel) {
          double x = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f& p = mesh.positions[mesh.triangles[faces[face].face][k].index()];
            x += weights[k] * (static_cast<double>(p.x) - bounds(model).low.x) / width;
          }
          std::fill_n(&painted.pixels[3 * texel], 3, static_cast<std::uint8_t>(60 + 128 * x));
          drawn[texel] = 1;
        },
        Context());
    filled = painted;
    fill_undrawn(filled, drawn, Context());
  }

  Image8 smaller() const {
    return resized(painted, kSmallerSide, kSmallerSide, {}, Wrap::clamp, Wrap::clamp, Context());
  }
  Image8 fitted() const {
    const MipMap whole = mip_map(filled, {});
    Image8 image = smaller();
    SeamFit(model, faces, faces).fit(image, whole, Wrap::clamp, Wrap::clamp, Context());
    return image;
  }
  double jump(const Image8& image) const {
    Model shown = model;
    shown.images[0].bytes = encode_png(image);
    Context context;
    return 255 * seam_jump(shown, context).mean;
  }
};

TEST(SeamFit, EdgesAreThoseWhereTheImageIsCut) {
  const Model cube = test::textured(test::cube(), 1), plane = test::textured(test::grid(3, 3), 1);
  const auto count = [](const Model& model) {
    return seam_edges(model, atlas_faces(model, find_atlases(model).at(0))).size();
  };
  EXPECT_EQ(count(cube), 24u) << "both sides of twelve";
  EXPECT_EQ(count(plane), 0u);
}

TEST(SeamFit, WhatLiesBesideChartsShowsNoMoreAtTheirSeams) {
  const Ramp ramp;
  EXPECT_LT(ramp.jump(ramp.filled), 2);
  const double before = ramp.jump(ramp.smaller());
  EXPECT_GT(before, 10);
  EXPECT_LT(ramp.jump(ramp.fitted()), before / 4);
}

TEST(SeamFit, IsForColorsThatHideWhatIsBehind) {
  EXPECT_TRUE(SeamFit::is_for({}));
  EXPECT_FALSE(SeamFit::is_for({.kind = TexelMeaning::Kind::normal}));
  EXPECT_FALSE(SeamFit::is_for({.kind = TexelMeaning::Kind::data}));
  EXPECT_FALSE(SeamFit::is_for({.transparent = true}));
}

TEST(SeamFit, WithoutSeamsNothingChanges) {
  const Model plane = test::textured(test::grid(3, 3), 1);
  const std::vector<AtlasFace> faces = atlas_faces(plane, find_atlases(plane).at(0));
  const Image8 painted = decode_image(plane.images[0].bytes);
  Image8 image =
      resized(painted, painted.width / 4, painted.height / 4, {}, Wrap::clamp, Wrap::clamp, Context());
  const Image8 before = image;
  const SeamFit fit(plane, faces, faces);
  EXPECT_FALSE(fit.has_seams());
  fit.fit(image, mip_map(painted, {}), Wrap::clamp, Wrap::clamp, Context());
  EXPECT_EQ(image.pixels, before.pixels);
}

TEST(SeamFit, TexelsThatNoSeamReadsStay) {
  const Ramp ramp;
  const Image8 before = ramp.smaller(), after = ramp.fitted();
  std::vector<std::uint8_t> at_seam(static_cast<std::size_t>(kSmallerSide * kSmallerSide), 0);
  std::vector<AtlasFace> edges;  // triangles that are an edge of a seam
  for (const SeamEdge& seam : seam_edges(ramp.model, ramp.faces)) {
    AtlasFace edge = ramp.faces[seam.face];
    const std::array<Vec2d, 3> uv = edge.uv;
    edge.uv = {uv[seam.corner], uv[(seam.corner + 1) % 3], uv[seam.corner]};
    edges.push_back(edge);
  }
  for_edge_texels(
      edges, kSmallerSide, kSmallerSide,
      [&](std::uint32_t, const std::array<double, 3>&, std::size_t texel) { at_seam[texel] = 1; });
  grow_drawn(at_seam, kSmallerSide, kSmallerSide, Context());  // as points lie elsewhere on edges
  std::size_t changed = 0, stayed = 0;
  for (std::size_t t = 0; t < at_seam.size(); ++t) {
    const bool is_same = std::equal(&before.pixels[3 * t], &before.pixels[3 * t] + 3, &after.pixels[3 * t]);
    EXPECT_TRUE(is_same || at_seam[t] != 0) << t;
    (is_same ? stayed : changed) += 1;
  }
  EXPECT_GT(changed, 100u);
  EXPECT_GT(stayed, 100u);
}

TEST(SeamFit, IsTheSameForAnyNumberOfThreads) {
  const Ramp ramp;
  const MipMap whole = mip_map(ramp.filled, {});
  std::vector<Image8> images(2, ramp.smaller());
  for (int threads = 1; threads <= 2; ++threads) {
    Context context;
    context.threads = threads;
    SeamFit(ramp.model, ramp.faces, ramp.faces)
        .fit(images[static_cast<std::size_t>(threads) - 1], whole, Wrap::clamp, Wrap::clamp, context);
  }
  EXPECT_EQ(images[0].pixels, images[1].pixels);
}

}  // namespace
}  // namespace fovea
