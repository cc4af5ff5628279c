#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "fovea/model/image.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"

namespace fovea::bench {

/// Views that are ready to be drawn: `size` × `size` pixels, four samples in each. The scene must outlive the
/// work.
struct ViewJob {
  const RenderScene* scene = nullptr;
  std::vector<View> views;
  int size = 512;
  int threads = 1;
};

/// Draws base colours with OpenGL ES on Mesa's llvmpipe, without a window: trilinear textures, alpha masks,
/// four samples per pixel, pictures read back. Blended surfaces are drawn last, in the order of the scene.
/// Throws Error(internal) without such a driver.
std::function<std::vector<Image8>()> llvmpipe_peer(const ViewJob& job);

/// Finds the nearest triangle for a ray through each sample with Embree, in coherent packets of eight;
/// returns how many rays hit. Nothing is shaded.
std::function<std::uint64_t()> embree_peer(const ViewJob& job);

}  // namespace fovea::bench
