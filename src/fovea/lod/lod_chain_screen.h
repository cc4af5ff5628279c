#pragma once

#include <cstdint>

#include "fovea/base/options.h"

namespace fovea {

/// The screen on which levels of detail change, and how much of it a switch may move.
struct LodScreen {
  double fov_deg = 60;  ///< Vertical angle of view.
  std::int64_t width = 1920, height = 1080;
  double pixel_error = 1;  ///< Of a level's largest error at the distance from which it is shown.
};
OptionList describe(LodScreen& screen);

// All distances go from the eye to the centre of the model's bounding sphere, in scene units; the error
// counts at the sphere's nearest point. Coverage is the part of the screen's height that the sphere's
// diameter takes: radius / (distance · tan(fov / 2)), as engines count it; above 1 the model is larger than
// the screen.

/// The distance at which a coverage is reached; `coverage` is above 0.
double distance_at(double coverage, double radius, const LodScreen& screen);
double coverage_at(double distance, double radius, const LodScreen& screen);
/// Pixels that a length takes at the near side of the sphere; infinite for an eye inside it, 0 for no length.
double pixels_at(double distance, double length, double radius, const LodScreen& screen);
/// The longest length that takes at most `pixel_error` pixels there; 0 for an eye inside the sphere.
double length_at(double distance, double radius, const LodScreen& screen);
/// The least distance at which a length takes at most `pixel_error` pixels.
double switch_distance(double length, double radius, const LodScreen& screen);
/// The part of the screen's area that a disc of that coverage takes, 1 at most.
double area_of(double coverage, const LodScreen& screen);

}  // namespace fovea
