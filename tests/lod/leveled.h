#pragma once

#include <utility>

#include "fovea/lod/levels_file.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/simplify/simplify.h"
#include "support/by_quadrics.h"

namespace fovea::test {

using Leveled = LeveledModel;

/// Down to so many triangles, or as few as there can be.
inline Leveled leveled(Model model, std::int64_t triangles, int threads = 2,
                       Placement placement = Placement::optimal) {
  Leveled result{std::move(model), {}};
  SimplifyOptions options = by_quadrics();
  options.triangles = triangles;
  options.placement = placement;
  Context context;
  context.threads = threads;
  CollapseRecord record = simplify(result.original, options, {}, context).record;
  result.levels = make_multi_tessellation(result.original, std::move(record), context);
  return result;
}

}  // namespace fovea::test
