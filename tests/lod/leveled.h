#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/levels_file.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/lod/step_bits.h"
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

/// A level that allows other errors at each vertex.
inline Cut random_cut(const MultiTessellation& levels, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> allowed(levels.first_vertex.back());
  const float most = static_cast<float>(random.uniform()) * 0.2f;
  for (float& a : allowed) a = most * static_cast<float>(random.uniform());
  return cut_within(levels, allowed);
}

/// Whether all steps that are taken have what they need.
inline bool is_closed(const MultiTessellation& levels, const Cut& cut) {
  for (std::size_t s = 0; s < cut.size(); ++s) {
    for (const std::uint32_t needed : levels.needs_of(s)) {
      if (cut[s] != 0 && cut[needed] == 0) return false;
    }
  }
  return true;
}

inline StepBits bits_of(const Cut& cut) {
  StepBits bits(cut.size());
  for (std::size_t s = 0; s < cut.size(); ++s) bits.set(s, cut[s] != 0);
  return bits;
}

}  // namespace fovea::test
