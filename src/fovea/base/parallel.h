#pragma once

#include <cstddef>
#include <functional>

#include "fovea/base/context.h"

namespace fovea {

/// Calls `body(begin, end)` on consecutive chunks of [0, count), in parallel on the threads of
/// `context`. Chunks are `grain` long (the last may be shorter) whatever the number of threads, so
/// a reduction that keeps one partial result per chunk (index begin / grain) and adds them in order
/// gives the same bits on any machine. Exceptions of `body` are rethrown. Calls for as many threads share
/// them, also if they come from several threads of the program.
void parallel_for(const Context& context, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// As `parallel_for`, but begins no chunk once the context is cancelled and then throws Error(cancelled): for
/// work without a usable partial result.
void parallel_for_or_throw(const Context& context, std::size_t count, std::size_t grain,
                           const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace fovea
