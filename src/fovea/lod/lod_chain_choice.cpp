#include "fovea/lod/lod_chain_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fovea {

namespace {

/// Of the triangles of a level, that a search may be off.
constexpr double kPrecision = 1.02;

}  // namespace

std::vector<std::uint64_t> lod_targets(const LodChainOptions& options, std::uint64_t total) {
  std::vector<std::uint64_t> targets;
  if (!options.triangles.empty()) {
    for (const std::int64_t count : options.triangles) targets.push_back(static_cast<std::uint64_t>(count));
  } else if (options.coverages.empty() && options.distances.empty()) {
    double share = static_cast<double>(total);
    for (std::int64_t level = 1; level < options.levels; ++level) {
      share *= options.ratio;
      targets.push_back(static_cast<std::uint64_t>(std::floor(share + 1e-9)));
    }
  }
  return targets;
}

std::vector<double> lod_distances(const LodChainOptions& options, double radius) {
  if (!options.triangles.empty()) return {};
  if (options.coverages.empty()) return options.distances;
  std::vector<double> distances;
  for (const double coverage : options.coverages)
    distances.push_back(distance_at(coverage, radius, options.screen));
  return distances;
}

LodChoice LodMeasure::level(std::uint64_t triangles) const {
  LodChoice choice;
  choice.steps = record_.steps_to(triangles);
  choice.triangles = record_.triangles_after(choice.steps);
  return choice;
}

LodChoice LodMeasure::at(std::uint64_t triangles) {
  LodChoice choice = level(triangles);
  for (const Measured& known : measured_) {
    if (known.whole && known.choice.steps == choice.steps) return known.choice;
  }
  if (choice.steps > 0) choice.error = reference_.error(replay(model_, record_, choice.steps), context_);
  measured_.push_back({choice, true, 0});
  return choice;
}

/// Whether what is known of a level says if it is within `length` in all key poses that there are by now.
bool LodMeasure::tells(const Measured& known, double length) const {
  return known.whole || known.key_poses == reference_.key_pose_count() || known.choice.error.max > length;
}

LodChoice LodMeasure::in_key_poses(std::uint64_t triangles, double length) {
  LodChoice choice = level(triangles);
  for (const Measured& known : measured_) {
    if (known.choice.steps == choice.steps && tells(known, length)) return known.choice;
  }
  if (choice.steps > 0)
    choice.error = reference_.error_in_key_poses(replay(model_, record_, choice.steps), context_);
  measured_.push_back({choice, false, reference_.key_pose_count()});
  return choice;
}

LodChoice LodMeasure::simplest_in_key_poses(double length) {
  const auto fits = [&](const LodChoice& choice) { return choice.error.max <= length; };
  LodChoice good = at(record_.triangles_before), bad = in_key_poses(0, length);
  if (fits(bad)) return bad;
  // What was measured before tells where to look.
  for (const Measured& known : measured_) {
    const LodChoice& choice = known.choice;
    if (tells(known, length) && fits(choice) && choice.triangles < good.triangles) good = choice;
  }
  for (const Measured& known : measured_) {
    const LodChoice& choice = known.choice;
    if (!fits(choice) && choice.triangles < good.triangles && choice.triangles > bad.triangles) bad = choice;
  }
  while (static_cast<double>(good.triangles) > kPrecision * static_cast<double>(bad.triangles)) {
    const double middle = std::sqrt(static_cast<double>(good.triangles) * static_cast<double>(bad.triangles));
    const LodChoice next = in_key_poses(static_cast<std::uint64_t>(middle), length);
    if (next.triangles >= good.triangles || next.triangles <= bad.triangles) break;
    (fits(next) ? good : bad) = next;
  }
  return good;
}

LodChoice LodMeasure::simplest(double length) {
  // A level that is beyond it in some other pose adds that to the key poses.
  for (;;) {
    const LodChoice found = at(simplest_in_key_poses(length).triangles);
    if (found.error.max <= length) return found;
  }
}

std::vector<LodChoice> rising(const std::vector<LodChoice>& choices, std::uint64_t total, Context& context) {
  std::vector<LodChoice> kept;
  const auto tell = [&](const char* code, const char* why, const LodChoice& choice) {
    context.report(code, fmt::format("a level was left out: {}", why),
                   fmt::format("level of {} triangles", choice.triangles));
  };
  for (LodChoice choice : choices) {
    if (choice.triangles >= (kept.empty() ? total : kept.back().triangles) ||
        !std::isfinite(choice.error.max)) {
      tell("lod-not-fewer", "it has no fewer triangles than the one before it", choice);
      continue;
    }
    while (!kept.empty() && kept.back().error.max >= choice.error.max) {
      tell("lod-not-nearer", "the next has fewer triangles and is as near to the original", kept.back());
      choice.distance = std::min(choice.distance, kept.back().distance);
      kept.pop_back();
    }
    kept.push_back(choice);
  }
  return kept;
}

}  // namespace fovea
