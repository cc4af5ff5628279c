#include "fovea/lod/lod_chain_screen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fovea {

namespace {

/// Of half the screen's height, at distance 1.
double half_height(const LodScreen& screen) { return std::tan(screen.fov_deg / 2 * std::numbers::pi / 180); }

/// At distance 1.
double pixel_size(const LodScreen& screen) {
  return 2 * half_height(screen) / static_cast<double>(screen.height);
}

}  // namespace

OptionList describe(LodScreen& screen) {
  return {
      {"pixel-error", "How many pixels of the screen a level may be off where it comes in; 1 is hard to see.",
       &screen.pixel_error, "pixels", 1e-3, 1e3},
      {"fov", "Vertical angle of view of the screen.", &screen.fov_deg, "degrees", 1, 170},
      {"width", "Width of the screen; counts for shares of its area alone.", &screen.width, "pixels", 16,
       1 << 16},
      {"height", "Height of the screen.", &screen.height, "pixels", 16, 1 << 16},
  };
}

double distance_at(double coverage, double radius, const LodScreen& screen) {
  return radius / (coverage * half_height(screen));
}

double coverage_at(double distance, double radius, const LodScreen& screen) {
  return radius / (distance * half_height(screen));
}

double pixels_at(double distance, double length, double radius, const LodScreen& screen) {
  if (!(length > 0)) return 0;
  if (distance <= radius) return std::numeric_limits<double>::infinity();
  return length / ((distance - radius) * pixel_size(screen));
}

double length_at(double distance, double radius, const LodScreen& screen) {
  return std::max(0.0, distance - radius) * pixel_size(screen) * screen.pixel_error;
}

double switch_distance(double length, double radius, const LodScreen& screen) {
  return radius + length / (pixel_size(screen) * screen.pixel_error);
}

double area_of(double coverage, const LodScreen& screen) {
  const double aspect = static_cast<double>(screen.height) / static_cast<double>(screen.width);
  return std::min(1.0, std::numbers::pi / 4 * coverage * coverage * aspect);
}

}  // namespace fovea
