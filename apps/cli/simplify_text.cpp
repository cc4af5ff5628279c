#include "simplify_text.h"

#include <fmt/format.h>

#include "report.h"
#include "text.h"

namespace fovea::cli {

namespace {

bool asks_for_count(const SimplifyOptions& options) { return options.triangles || options.ratio; }

std::string stop_text(const SimplifyResult& result, bool reached) {
  switch (result.stop) {
    case StopReason::target:
      return "target of " + plural(result.triangles_target, "triangle", "triangles") + " reached";
    case StopReason::error: return "error bound reached: the next step would exceed it";
    case StopReason::cancelled: return "cancelled";
    case StopReason::stuck: break;
  }
  if (reached) return "as simple as it gets: no edge is left that may collapse";
  return fmt::format("stuck, {} above the target of {}",
                     plural(result.triangles_after - result.triangles_target, "triangle", "triangles"),
                     count_text(result.triangles_target));
}

/// Which metric decided, from how many triangles on.
std::string metric_text(const SimplifyResult& result) {
  if (result.metric_from == 0 || result.metric_from >= result.triangles_before)
    return to_string(result.metric);
  return fmt::format("{} from {} on, quadric before", to_string(result.metric),
                     plural(result.metric_from, "triangle", "triangles"));
}

std::string blocked_text(const BlockCounts& blocked, const SimplifyOptions& options) {
  if (blocked.edges == 0) return {};
  TextTable table("lrl");
  const auto row = [&](const char* name, std::uint64_t count, const char* why) {
    if (count > 0) table.row({name, count_text(count), why});
  };
  row("locked", blocked.locked,
      options.lock_boundary ? "no end may move: drop --lock-boundary"
                            : "no end may move: lower the --importance");
  row("topology", blocked.topology,
      options.keep_topology ? "would close a hole or pinch the surface: drop --keep-topology"
                            : "would pinch the surface: no option allows that");
  row("flip", blocked.flip, "would fold the surface or its texture over: no option allows that");
  row("last", blocked.last,
      options.keep_topology ? "the last triangles of a piece: drop --keep-topology, so that it may vanish"
                            : "the last triangles of the model: one piece always stays");
  return fmt::format("{} left cannot collapse:\n{}", plural(blocked.edges, "edge", "edges"), table.text(2));
}

}  // namespace

bool reached_target(const SimplifyResult& result, const SimplifyOptions& options) {
  if (result.stop != StopReason::stuck || !asks_for_count(options))
    return result.stop != StopReason::cancelled;
  return result.triangles_after <= result.triangles_target;
}

Json result_json(const SimplifyResult& result, const SimplifyOptions& options, bool reached) {
  const BlockCounts& b = result.blocked;
  return {{"triangles_target", asks_for_count(options) ? Json(result.triangles_target) : Json()},
          {"triangles", result.triangles_after},
          {"reached", reached},
          {"stop", to_string(result.stop)},
          {"error_rel", number_json(result.error_rel)},
          {"error_abs", number_json(result.error_abs)},
          {"metric", to_string(result.metric)},
          {"metric_from_triangles", result.metric_from},
          {"hidden", result.triangles_hidden},
          {"blocked",
           {{"edges", b.edges},
            {"topology", b.topology},
            {"folds", b.flip},
            {"locked", b.locked},
            {"last", b.last}}}};
}

std::string result_text(const SimplifyResult& result, const SimplifyOptions& options) {
  const bool reached = reached_target(result, options);
  TextTable table("l");
  table.row({"error", fmt::format("{} of the diagonal, {} units", number_text(result.error_rel),
                                  number_text(result.error_abs))});
  table.row({"metric", metric_text(result)});
  if (result.triangles_hidden > 0) {
    table.row({"hidden",
               plural(result.triangles_hidden, "triangle that no view sees", "triangles that no view sees") +
                   " dropped"});
  }
  table.row({"stopped", stop_text(result, reached)});
  return table.text(0) + blocked_text(result.blocked, options);
}

}  // namespace fovea::cli
