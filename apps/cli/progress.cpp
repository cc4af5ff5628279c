#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace fovea::cli {

namespace {

constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr int kBarWidth = 30;

bool is_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

}  // namespace

Progress::Progress(bool wanted) : active_(wanted && is_terminal()) {}

void Progress::show(std::string_view phase, double fraction) {
  if (!active_) return;
  const auto now = Clock::now();
  if (phase != phase_) {
    phase_ = phase;
    phase_start_ = now;
  } else if (now - last_draw_ < kRedraw) {
    return;
  }
  last_draw_ = now;
  const double elapsed = std::chrono::duration<double>(now - phase_start_).count();
  const std::string line = progress_line(phase_, fraction, elapsed);
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

std::string progress_line(std::string_view phase, double fraction, double elapsed) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kBarWidth);
  std::string line = fmt::format("{:<12} [{}{}] {:3.0f} %", phase, std::string(filled, '='),
                                 std::string(kBarWidth - filled, ' '), std::floor(100 * fraction));
  if (elapsed > 1 && fraction > 0.01) {
    const long left = std::lround(elapsed * (1 - fraction) / fraction);
    line += left < 3600 ? fmt::format("  {}:{:02} left", left / 60, left % 60)
                        : fmt::format("  {} h {:02} min left", left / 3600, left / 60 % 60);
  }
  return line;
}

}  // namespace fovea::cli
