#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>

#include "fovea/base/error.h"
#include "fovea/simplify/simplify.h"
#include "support/any_model.h"
#include "support/result_fault.h"

namespace fovea {
namespace {

constexpr std::array<Metric, 6> kMetrics{Metric::quadric,         Metric::visibility, Metric::entropy,
                                         Metric::polygon_entropy, Metric::image,      Metric::automatic};

/// Simplifies the model of a seed and says what is wrong; empty if nothing is. Whole models that nothing sees
/// may be refused.
std::string fault_of_seed(std::uint64_t seed, Metric metric) {
  test::Choices choices(seed);
  const Model model = test::any_model(choices);
  const Importance importance = test::any_importance(choices, model);
  const SimplifyOptions options = test::any_simplify_options(choices, metric);
  Context context;
  context.threads = 1;
  try {
    const SimplifyResult result = simplify(model, options, importance, context);
    std::string fault = test::fault_of({model, options, importance, result});
    if (!fault.empty() || seed % 8 != 0) return fault;
    Context other;
    other.threads = 3;
    fault = test::difference(result, simplify(model, options, importance, other));
    return fault.empty() ? "" : "with three threads: " + fault;
  } catch (const Error& error) {
    const bool refused = error.kind() == ErrorKind::unsupported && options.cull_hidden;
    return refused ? "" : error.what();
  }
}

// A thousand models through every metric, each with options of its own. What must hold of any result is in
// support/result_fault.h. FOVEA_SEEDS=FIRST,COUNT tries others.
TEST(AnyModel, KeepsWhatMustAlwaysHold) {
  std::uint64_t first = 1, count = 1000;
  if (const char* seeds = std::getenv("FOVEA_SEEDS")) {
    const std::string text = seeds;
    first = std::stoull(text);
    count = std::stoull(text.substr(text.find(',') + 1));
  }
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    for (const Metric metric : kMetrics) {
      const std::string fault = fault_of_seed(seed, metric);
      EXPECT_EQ(fault, "") << "seed " << seed << ", metric " << to_string(metric);
    }
  }
}

}  // namespace
}  // namespace fovea
