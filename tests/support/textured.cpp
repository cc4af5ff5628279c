#include "support/textured.h"

#include <algorithm>
#include <utility>

#include "fovea/io/image_codec.h"
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

}  // namespace fovea::test
