#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace fovea {

/// A repair, drop or oddity that the user should know of and that did not stop the work.
/// Equal codes are counted, not repeated; `place` and `message` are those of the first.
struct Diagnostic {
  std::string code;     ///< Stable, machine-readable: "degenerate-triangles".
  std::string message;  ///< One line for people, without the count.
  std::string place;    ///< File and JSON pointer, mesh name, ... of the first occurrence.
  std::uint64_t count = 0;
};

/// What a call may use and whom it tells: threads, seed, progress, cancellation, diagnostics.
/// Passed by reference through the library; there is no global state.
class Context {
 public:
  /// Threads to use; 0 means all that the machine has. Results do not depend on it.
  int threads = 0;
  /// Seed of every random choice.
  std::uint64_t seed = 1;
  /// Called now and then with the phase ("collapse") and the fraction done in [0, 1]; from the
  /// calling thread only. Returning false cancels.
  std::function<bool(std::string_view phase, double fraction)> progress;

  /// Number of threads that `threads` resolves to; at least 1.
  int thread_count() const;

  /// Asks the running call to stop; safe from a signal handler or another thread.
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  /// Tells progress and returns whether to go on. Cheap when nobody listens.
  bool advance(std::string_view phase, double fraction);
  /// As `advance`, but throws Error(cancelled) instead of returning false: for phases without a
  /// usable partial result.
  void advance_or_throw(std::string_view phase, double fraction);

  /// Records a diagnostic; thread-safe.
  void report(std::string_view code, std::string_view message, std::string_view place = {},
              std::uint64_t count = 1);
  /// Diagnostics so far, sorted by code.
  std::vector<Diagnostic> diagnostics() const;

 private:
  std::atomic<bool> cancelled_{false};
  mutable std::mutex mutex_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace fovea
