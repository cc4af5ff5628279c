#include "fovea/sample/builder.h"

#include <utility>

#include "fovea/io/image_codec.h"

namespace fovea::sample {

namespace {

constexpr int kJpegQuality = 92;  // From 90 on no chroma is thrown away; above, bytes grow fast.
constexpr int kLinear = 9729, kTrilinear = 9987;

template <class T>
int append(std::vector<T>& list, T element) {
  list.push_back(std::move(element));
  return static_cast<int>(list.size()) - 1;
}

EncodedImage encode(const Image8& image, ImageFormat format, const std::string& name) {
  EncodedImage encoded;
  encoded.name = name;
  encoded.mime_type = format == ImageFormat::png ? "image/png" : "image/jpeg";
  encoded.bytes = format == ImageFormat::png ? encode_png(image) : encode_jpeg(image, kJpegQuality);
  return encoded;
}

}  // namespace

int add_material(Model& model, const PaintedMaterial& painted, const Image8& base_color) {
  return add_material(model, painted, encode(base_color, painted.format, painted.name));
}

int add_material(Model& model, const PaintedMaterial& painted, EncodedImage base_color) {
  Sampler sampler;
  sampler.wrap_u = sampler.wrap_v = painted.tiled ? Wrap::repeat : Wrap::clamp;
  sampler.mag_filter = kLinear;
  sampler.min_filter = kTrilinear;
  Texture texture;
  texture.name = painted.name;
  texture.image = append(model.images, std::move(base_color));
  texture.sampler = append(model.samplers, std::move(sampler));
  Material material;
  material.name = painted.name;
  material.base_color.emplace().texture = append(model.textures, std::move(texture));
  material.metallic_factor = 0;
  material.roughness_factor = painted.roughness;
  material.double_sided = painted.double_sided;
  return append(model.materials, std::move(material));
}

int add_mesh(Model& model, const std::string& name, const std::vector<SplitPart>& parts, Context& context) {
  Mesh mesh;
  mesh.name = name;
  mesh.surface = weld(parts, context, name);
  mesh.morph_weights.assign(mesh.surface.target_count(), 0.0);
  Node node;
  node.name = name;
  node.mesh = append(model.meshes, std::move(mesh));
  const int index = append(model.nodes, std::move(node));
  model.scenes[0].nodes.push_back(index);
  return index;
}

void add_animation(Model& model, const std::string& name, int node, const std::string& path,
                   const std::vector<float>& times, const std::vector<float>& values, int width) {
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats(times, 1);
  sampler.output = Accessor::from_floats(values, width);
  Animation animation;
  animation.name = name;
  animation.samplers.push_back(std::move(sampler));
  animation.channels.push_back({0, node, path, {}});
  model.animations.push_back(std::move(animation));
}

Model empty_model(const std::string& scene) {
  Model model;
  model.scenes.resize(1);
  model.scenes[0].name = scene;
  model.default_scene = 0;
  return model;
}

}  // namespace fovea::sample
