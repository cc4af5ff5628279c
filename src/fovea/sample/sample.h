#pragma once

#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"

namespace fovea {

/// A model that Fovea makes itself, so that it can be tried and tested without any file.
struct SampleInfo {
  std::string name;         ///< "vase"
  std::string description;  ///< One line.
};

/// What `make_sample` knows, in the order of `fovea sample --list`.
std::vector<SampleInfo> samples();

/// Makes a sample: `vase` (a plain figure painted on a busy ground, after Yang et al. 2016), `arm` (a
/// skinned, bending arm, after Munaretti 2007), `spheres` (two near spheres, one of which a morph
/// target deforms, idem figure 3.4), `terrain` (a block of earth whose heights have a photo-like
/// texture, after Horbelt et al. 2001). Each has tens of thousands of triangles, real UV seams and textures
/// made for it. `detail` scales the number of triangles (1 = default). Deterministic in the seed of
/// `context`.
///
/// Throws Error(usage) for an unknown name, with the nearest one.
Model make_sample(const std::string& name, double detail, Context& context);

}  // namespace fovea
