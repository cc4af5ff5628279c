#include "support/textured.h"

#include <algorithm>
#include <utility>

#include "fovea/base/random.h"
#include "fovea/io/image_codec.h"
#include "fovea/texture/bake.h"
#include "support/meshes.h"
#include "support/pictures.h"

namespace fovea::test {

Model textured(TriMesh mesh, int images) {
  for (Part& part : mesh.parts) part.material = std::max(part.material, 0);
  Model model = model_of(std::move(mesh));
  model.materials.resize(std::max<std::size_t>(model.materials.size(), 1));
  for (int i = 0; i < images; ++i) {
    EncodedImage image;
    image.mime_type = "image/png";
    image.bytes = encode_png(pattern(64, 64));
    model.images.push_back(image);
    model.textures.push_back({i, -1, "", ""});
  }
  model.materials[0].base_color = TextureRef{0, 0, {}};
  if (images > 1) model.materials[0].normal = TextureRef{1, 0, {}};
  return model;
}

Model small_charts(int side) {
  Model model = textured(grid(9, 9), 1);
  TriMesh& mesh = model.meshes[0].surface;
  AttributeLayer& uvs = *std::ranges::find(mesh.layers, Semantic::uv, &AttributeLayer::semantic);
  std::vector<float> values;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 2; ++c) {
        const auto at = [&](std::size_t corner) { return uvs.value(uvs.corner_value[3 * f + corner])[c]; };
        const float middle = (at(0) + at(1) + at(2)) / 3;
        values.push_back(middle + 0.6F * (at(k) - middle));
      }
    }
  }
  uvs.values = std::move(values);
  for (std::size_t c = 0; c < uvs.corner_value.size(); ++c) uvs.corner_value[c] = ValueId{c};
  Image8 image(side, side, 3, ColorEncoding::srgb);
  Random random(3);
  const std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model).at(0));
  const std::vector<std::uint8_t> read = read_texels(faces, side, side, {});
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const bool is_dark = (x * 80 / side + y * 80 / side) % 2 == 0;
      const bool is_shown = read[static_cast<std::size_t>(y * side + x)] != 0;
      const double value = is_shown ? 64 + 128 * random.uniform() : is_dark ? 0 : 255;
      std::fill_n(image.at(x, y), 3, static_cast<std::uint8_t>(value));
    }
  }
  model.images[0].bytes = encode_png(image);
  return model;
}

}  // namespace fovea::test
