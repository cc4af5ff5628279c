#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fovea/judge/picture_scores.h"
#include "fovea/lod/level_selection.h"
#include "fovea/lod/vertex_hierarchy.h"
#include "session.h"

namespace fovea::cli {

/// How the eye moves.
enum class FlightPath {
  orbit,     ///< Once around the model, as far away as shows it whole.
  approach,  ///< The same, close to the surface halfway.
};

struct FlightOptions {
  FlightPath path = FlightPath::approach;
  std::int64_t frames = 60;
  std::int64_t size = 512;       ///< Pixels along each side of a picture.
  std::int64_t spread = 1;       ///< Frames over which the work for a level is spread.
  std::int64_t judge_every = 6;  ///< Every so manieth frame is compared with the original; 0 none.
};
OptionList describe(FlightOptions& options);

/// The eye in each frame; the first and the last see the same.
std::vector<LevelCamera> flight_cameras(const FlightOptions& options, const Sphere& sphere);

/// What a frame took, in milliseconds, and what it showed.
struct FrameReport {
  double ratio = 0;  ///< Of triangles asked for.
  int frame = 0;
  std::uint64_t triangles = 0;
  std::uint64_t cracks = 0;  ///< Edges that are open though the original is not (level_cracks.h).
  double cpu_update_ms = 0;  ///< Selection and contraction on the processor.
  std::optional<double> full_draw_ms, cpu_draw_ms;   ///< With a card: the original; that level, uploaded.
  std::optional<double> gpu_update_ms, gpu_draw_ms;  ///< Selection, and contraction on the card; drawing.
  std::optional<ImageScores> scores;                 ///< Against the original, lit.
};

struct FlightReport {
  std::vector<FrameReport> frames;
  std::vector<std::vector<Image8>>
      strip;  ///< Pictures of judged frames: of the original, then of each ratio.
};

/// Flies along the path once for each ratio. With `use_card`, frames are drawn and contracted there too, in
/// the context that is current; both must give the same indices, or Error(internal) says so.
FlightReport fly(const Model& original, const VertexHierarchy& hierarchy, LevelSelection& selection,
                 const std::vector<double>& ratios, const FlightOptions& options, bool use_card,
                 Session& session);

}  // namespace fovea::cli
