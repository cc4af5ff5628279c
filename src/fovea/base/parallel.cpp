#include "fovea/base/parallel.h"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "fovea/base/error.h"

namespace fovea {

namespace {

/// The arena of so many threads. It is kept, as threads come to a new one too late for small work.
oneapi::tbb::task_arena& arena_of(int threads) {
  static std::mutex mutex;
  static std::map<int, oneapi::tbb::task_arena> arenas;
  const std::lock_guard lock(mutex);
  return arenas.try_emplace(threads, threads).first->second;
}

}  // namespace

void parallel_for(const Context& context, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  const auto run_chunk = [&](std::size_t chunk) {
    body(chunk * grain, std::min(count, (chunk + 1) * grain));
  };
  // An arena larger than the machine gains nothing and makes TBB print a warning.
  const int threads = std::min(context.thread_count(), oneapi::tbb::info::default_concurrency());
  if (threads == 1 || chunks == 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) run_chunk(chunk);
    return;
  }
  arena_of(threads).execute([&] { oneapi::tbb::parallel_for(std::size_t{0}, chunks, run_chunk); });
}

void parallel_for_or_throw(const Context& context, std::size_t count, std::size_t grain,
                           const std::function<void(std::size_t, std::size_t)>& body) {
  parallel_for(context, count, grain, [&](std::size_t begin, std::size_t end) {
    if (!context.cancelled()) body(begin, end);
  });
  if (context.cancelled()) throw Error(ErrorKind::cancelled, "cancelled");
}

}  // namespace fovea
