#pragma once

#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/model/weld.h"

namespace fovea::sample {

/// How a painted image is stored.
enum class ImageFormat { png, jpeg };

/// A dielectric material with its base colour painted: image, texture, sampler and material.
struct PaintedMaterial {
  std::string name;
  ImageFormat format = ImageFormat::jpeg;
  double roughness = 0.5;
  bool double_sided = false;
  bool tiled = false;  ///< Repeats instead of being clamped at its rim.
};

/// Appends it to the model and returns the material's index.
int add_material(Model& model, const PaintedMaterial& material, const Image8& base_color);
/// The same with an image that is encoded already.
int add_material(Model& model, const PaintedMaterial& material, EncodedImage base_color);

/// Welds the parts to a mesh and appends it with a node that shows it. Returns the node's index.
int add_mesh(Model& model, const std::string& name, const std::vector<SplitPart>& parts, Context& context);

/// Appends an animation of one channel: `values` [#times × width] of `node`'s `path`, linear.
void add_animation(Model& model, const std::string& name, int node, const std::string& path,
                   const std::vector<float>& times, const std::vector<float>& values, int width);

/// A model with one empty scene.
Model empty_model(const std::string& scene);

Model make_vase(double detail, Context& context);
Model make_arm(double detail, Context& context);
Model make_spheres(double detail, Context& context);
Model make_terrain(double detail, Context& context);

}  // namespace fovea::sample
