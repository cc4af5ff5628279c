#pragma once

#include "fovea/lod/lod_chain.h"

namespace fovea::test {

/// Options for quick chains: quadrics, few samples, no pictures.
inline LodChainOptions quick_chain() {
  LodChainOptions options;
  options.simplify.metric = Metric::quadric;
  options.distance_samples = 2000;
  options.pictures = false;
  return options;
}

}  // namespace fovea::test
