#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace fovea::cli {

/// A bar on stderr with phase, percent and time left; at most ten redraws a second.
class Progress {
 public:
  /// Draws nothing unless `wanted` and stderr is a terminal.
  explicit Progress(bool wanted);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  bool active() const { return active_; }
  void show(std::string_view phase, double fraction);
  /// Takes the bar away, so that other text can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool active_;
  bool drawn_ = false;
  std::string phase_;
  Clock::time_point phase_start_, last_draw_;
};

/// The bar's line: "collapse      [=====     ]  50 %  0:12 left". The time left comes from the
/// fraction done in `elapsed` seconds, and is only told once it means something.
std::string progress_line(std::string_view phase, double fraction, double elapsed);

}  // namespace fovea::cli
