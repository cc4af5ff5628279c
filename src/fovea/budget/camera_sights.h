#pragma once

#include <span>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"
#include "fovea/texture/image_viewers.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// What some views see of a model's images in pictures `size` pixels high: each look is a pixel's, up to
/// 32,768 over all pictures, and of an image only those waves are shown that take two pixels somewhere
/// (wavelet.h; Horbelt, Balmelli and Vetterli 2001). `scene` is of the model and has its textures; the result
/// refers to neither. Throws Error(cancelled). Cost: that of twice the pictures.
ImageViewers camera_sights(const Model& model, const RenderScene& scene, std::span<const View> views,
                           int size, const Context& context);

}  // namespace fovea
