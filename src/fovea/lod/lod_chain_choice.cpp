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

LodChoice LodMeasure::at(std::uint64_t triangles) {
  LodChoice choice;
  choice.steps = record_.steps_to(triangles);
  choice.triangles = record_.triangles_after(choice.steps);
  for (const LodChoice& known : measured_) {
    if (known.steps == choice.steps) return known;
  }
  if (choice.steps > 0) choice.error = reference_.error(replay(model_, record_, choice.steps), context_);
  measured_.push_back(choice);
  return choice;
}

LodChoice LodMeasure::simplest(double length) {
  const auto fits = [&](const LodChoice& choice) { return choice.error.max <= length; };
  LodChoice good = at(record_.triangles_before), bad = at(0);
  if (fits(bad)) return bad;
  // What was measured for other levels tells where to look.
  for (const LodChoice& known : measured_) {
    if (fits(known) && known.triangles < good.triangles) good = known;
  }
  for (const LodChoice& known : measured_) {
    if (!fits(known) && known.triangles < good.triangles && known.triangles > bad.triangles) bad = known;
  }
  while (static_cast<double>(good.triangles) > kPrecision * static_cast<double>(bad.triangles)) {
    const double middle = std::sqrt(static_cast<double>(good.triangles) * static_cast<double>(bad.triangles));
    const LodChoice next = at(static_cast<std::uint64_t>(middle));
    if (next.triangles >= good.triangles || next.triangles <= bad.triangles) break;
    (fits(next) ? good : bad) = next;
  }
  return good;
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
