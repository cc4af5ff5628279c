#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "fovea/base/context.h"

namespace fovea {

/// Threads for many small pieces of parallel work, one soon after the other: they wait awake for the next for
/// some tens of microseconds before they sleep, where those of `parallel_for` have to be woken each time.
/// Belongs to one thread, which works too.
class Team {
 public:
  /// As many threads as `context` allows and the machine has, the caller among them.
  explicit Team(const Context& context);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls body(i) for 0 … count-1 in parallel and returns when all are done. Whoever is free takes the next.
  /// The first exception is rethrown; what has not begun then is left out.
  void run(std::size_t count, const std::function<void(std::size_t)>& body);

 private:
  void help();
  void work();

  // Of the work that is going on: written while it is closed and nobody is inside.
  const std::function<void(std::size_t)>* body_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> is_open_{false};
  std::atomic<int> inside_{0};  // helpers that look at it
  std::atomic<std::uint32_t> calls_{0};
  std::atomic<bool> ends_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
  std::vector<std::thread> helpers_;
};

}  // namespace fovea
