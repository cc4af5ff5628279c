#include <gtest/gtest.h>

#include <cmath>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/model.h"
#include "fovea/sample/sample.h"
#include "fovea/surface/topology.h"

namespace fovea {
namespace {

/// Heights x + 10 y, in 255ths.
Image8 slope(int width, int height, int channels = 1) {
  Image8 image(width, height, channels, ColorEncoding::srgb);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(x + 10 * y);
    }
  }
  return image;
}

TerrainMap map_of(const Image8& heights) {
  TerrainMap map;
  map.heights = decode_heights(encode_png(heights));
  map.texture.bytes = encode_png(slope(4, 4, 3));
  map.texture.mime_type = "image/png";
  return map;
}

TEST(TerrainMap, HasAVertexForEachPixel) {
  Context context;
  TerrainMap map = map_of(slope(6, 4));
  map.width = 12;
  map.relief = 255;
  const Model model = make_terrain(map, 1, context);
  EXPECT_TRUE(context.diagnostics().empty());
  const TriMesh& mesh = model.meshes[0].surface;
  EXPECT_NO_THROW(check(mesh));
  EXPECT_EQ(mesh.vertex_count(), 24u);
  EXPECT_EQ(mesh.face_count(), 30u);
  EXPECT_EQ(count_edges(mesh).boundary, 2u * (5 + 3));
  // Pixels of 2 m; the north-west is at the top left of the map.
  const AttributeLayer& uv = *mesh.find(Semantic::uv);
  for (std::uint32_t c = 0; c < 3 * mesh.face_count(); ++c) {
    const Vec3f p = mesh.positions[mesh.vertex(CornerId{c}).index()];
    const float x = p.x / 2 + 2.5f, y = p.z / 2 + 1.5f;
    EXPECT_NEAR(p.y, x + 10 * y, 1e-4);
    EXPECT_NEAR(uv.value(uv.corner_value[c])[0], (x + 0.5f) / 6, 1e-6);
    EXPECT_NEAR(uv.value(uv.corner_value[c])[1], (y + 0.5f) / 4, 1e-6);
  }
  for (const auto& t : mesh.triangles) {
    const Vec3f a = mesh.positions[t[0].index()], b = mesh.positions[t[1].index()],
                c = mesh.positions[t[2].index()];
    EXPECT_GT(cross(b - a, c - a).y, 0) << "seen from above";
  }
  EXPECT_EQ(model.images[0], map.texture) << "as its file holds it";
}

TEST(TerrainMap, DetailTakesMeans) {
  Context context;
  const Model model = make_terrain(map_of(slope(21, 11)), 0.04, context);
  const TriMesh& mesh = model.meshes[0].surface;
  EXPECT_EQ(mesh.face_count(), 2u * 4 * 2);
  // A slope stays one inside; at the rim half of the pixels are missing.
  for (const Vec3f p : mesh.positions) {
    if (std::abs(p.x) > 4 || std::abs(p.z) > 2) continue;
    EXPECT_NEAR(p.y, ((p.x / 10 * 21 + 10) + 10 * (p.z / 10 * 21 + 5)) / 255, 1e-4);
  }
  EXPECT_THROW(make_terrain(map_of(slope(4, 4)), 1.1, context), Error);
  EXPECT_EQ(make_terrain(map_of(slope(4, 4)), 1e-6, context).meshes[0].surface.face_count(), 2u);
}

TEST(TerrainMap, RefusesWhatIsNoHeightMap) {
  const auto kind = [](const Image8& image) {
    try {
      decode_heights(encode_png(image));
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  Image8 colored = slope(4, 4, 3);
  colored.at(2, 2)[1] ^= 1;
  EXPECT_EQ(kind(colored), ErrorKind::unsupported);
  EXPECT_EQ(kind(slope(1, 4)), ErrorKind::unsupported);
  EXPECT_THROW(decode_heights({}), Error);
  // Grey as three channels or with alpha is grey.
  EXPECT_EQ(decode_heights(encode_png(slope(5, 4, 3))).pixels,
            decode_heights(encode_png(slope(5, 4))).pixels);
  EXPECT_EQ(decode_heights(encode_png(slope(5, 4, 2))).pixels,
            decode_heights(encode_png(slope(5, 4))).pixels);
  Context context;
  TerrainMap map = map_of(slope(4, 4));
  map.width = 0;
  EXPECT_THROW(make_terrain(map, 1, context), Error);
}

}  // namespace
}  // namespace fovea
