#pragma once

#include "fovea/simplify/simplify.h"

namespace fovea::test {

/// For tests of the engine and of what comes after it: the quadric error alone, which looks at no pictures.
inline SimplifyOptions by_quadrics() {
  SimplifyOptions options;
  options.metric = Metric::quadric;
  return options;
}

}  // namespace fovea::test
