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
  Image8 fitted(const TexelMeaning& meaning = {}) const {
    const MipMap whole = mip_map(filled, meaning);
    Image8 image = smaller();
    fit_seams(image, faces, Wrap::clamp, Wrap::clamp, seam_edges(model, faces), model,
              {&whole, faces, meaning});
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

TEST(SeamFit, OnlyColorsChangeAndNothingWithoutSeams) {
  const Ramp ramp;
  EXPECT_EQ(ramp.fitted({.kind = TexelMeaning::Kind::normal}).pixels, ramp.smaller().pixels);
  EXPECT_EQ(ramp.fitted({.kind = TexelMeaning::Kind::data}).pixels, ramp.smaller().pixels);
  EXPECT_EQ(ramp.fitted({.transparent = true}).pixels, ramp.smaller().pixels);
  // Without seams nothing is sought.
  const Model plane = test::textured(test::grid(3, 3), 1);
  const std::vector<AtlasFace> faces = atlas_faces(plane, find_atlases(plane).at(0));
  const MipMap whole = mip_map(decode_image(plane.images[0].bytes), {});
  Image8 image = ramp.smaller();
  fit_seams(image, faces, Wrap::clamp, Wrap::clamp, seam_edges(plane, faces), plane, {&whole, faces, {}});
  EXPECT_EQ(image.pixels, ramp.smaller().pixels);
}

}  // namespace
}  // namespace fovea
