#pragma once

#include <set>
#include <span>
#include <vector>

#include "fovea/texture/atlas.h"
#include "fovea/texture/shrink.h"
#include "fovea/texture/texture_budget.h"

// Private to texture/.

namespace fovea {

/// A model before its images change.
struct PreparedModel {
  Model model;
  std::vector<ImageChange::State> files;  // [#images] that nothing may take more than
  std::vector<Atlas> atlases;
  std::vector<Atlas> originals;  // of the model that it was simplified from, if images are baked anew
  std::set<int> new_maps;        // images that are to hold normals which no image held
};

/// `options` say which model its images are baked anew from, if any. O(#F + bytes of images).
PreparedModel prepare_images(const Model& model, const RebakeOptions& options);

/// Makes images smaller, one atlas after the other. `wanted` [#images] of the prepared model are their sizes
/// and qualities; images that cannot be as wanted stay and say why. Throws Error(cancelled).
Shrunk with_images(const PreparedModel& prepared, std::span<const WantedImage> wanted,
                   const ShrinkOptions& options, std::span<const VertexField> field, Context& context);

}  // namespace fovea
