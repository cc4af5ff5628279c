#include "fovea/sample/sample.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/base/options.h"
#include "fovea/sample/builder.h"

namespace fovea {

namespace {

struct Entry {
  const char* name;
  const char* description;
  Model (*make)(double detail, Context& context);
};

constexpr std::array kEntries{
    Entry{"vase", "A plain figure painted on a busy ground, on a vase with handles", sample::make_vase},
    Entry{"arm", "A skinned arm that bends at the elbow", sample::make_arm},
    Entry{"spheres", "Two near spheres, one of which a morph target deforms", sample::make_spheres},
    Entry{"terrain", "Mountains with a photo-like texture, cut out as a block of earth",
          sample::make_terrain},
};

// Below, the figures fall apart; above, indices come near their limit of 32 bits.
constexpr double kLeastDetail = 0.001, kMostDetail = 1000;

[[noreturn]] void unknown_name(const std::string& name) {
  std::vector<std::string> names;
  for (const Entry& entry : kEntries) names.emplace_back(entry.name);
  const std::vector<std::string> nearest = nearest_names(name, names);
  throw Error(ErrorKind::usage, fmt::format("there is no sample '{}'", name), {},
              nearest.empty() ? fmt::format("samples: {}", fmt::join(names, ", "))
                              : fmt::format("did you mean '{}'?", nearest[0]));
}

}  // namespace

std::vector<SampleInfo> samples() {
  std::vector<SampleInfo> list;
  for (const Entry& entry : kEntries) list.push_back({entry.name, entry.description});
  return list;
}

Model make_sample(const std::string& name, double detail, Context& context) {
  if (!(detail >= kLeastDetail && detail <= kMostDetail)) {
    throw Error(ErrorKind::usage, fmt::format("detail {} is out of range", detail), {},
                fmt::format("allowed: {}..{}", kLeastDetail, kMostDetail));
  }
  for (const Entry& entry : kEntries) {
    if (name != entry.name) continue;
    context.advance_or_throw("sample", 0);
    return entry.make(detail, context);
  }
  unknown_name(name);
}

}  // namespace fovea
