#include "fovea/base/context.h"

#include <algorithm>
#include <thread>

#include "fovea/base/error.h"

namespace fovea {

int Context::thread_count() const {
  if (threads > 0) return threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool Context::advance(std::string_view phase, double fraction) {
  if (progress && !progress(phase, std::clamp(fraction, 0.0, 1.0))) cancel();
  return !cancelled();
}

void Context::advance_or_throw(std::string_view phase, double fraction) {
  if (!advance(phase, fraction)) throw Error(ErrorKind::cancelled, "cancelled");
}

void Context::report(std::string_view code, std::string_view message, std::string_view place,
                     std::uint64_t count) {
  const std::lock_guard lock(mutex_);
  const auto at = std::lower_bound(diagnostics_.begin(), diagnostics_.end(), code,
                                   [](const Diagnostic& d, std::string_view c) { return d.code < c; });
  if (at != diagnostics_.end() && at->code == code) {
    at->count += count;
  } else {
    diagnostics_.insert(at, {std::string(code), std::string(message), std::string(place), count});
  }
}

std::vector<Diagnostic> Context::diagnostics() const {
  const std::lock_guard lock(mutex_);
  return diagnostics_;
}

}  // namespace fovea
