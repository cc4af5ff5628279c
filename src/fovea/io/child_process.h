#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fovea/base/context.h"

namespace fovea {

/// What a child process may use.
struct ChildLimits {
  std::uint64_t memory_bytes = std::uint64_t{16} << 30;  ///< Beyond what it begins with.
  std::uint64_t result_bytes = std::uint64_t{16} << 30;
  std::uint64_t cpu_seconds = 600;
};

/// Runs `work` in a copy of this process and returns what it returns, so that code which may crash,
/// hang or eat memory on hostile data can do so without harm. The copy has one thread: `work` must
/// not use the thread pool, nor print (its output goes nowhere). `fovea::Error` passes through.
///
/// Throws Error(format) with `place` if the copy crashes, Error(limit) if it exceeds a limit,
/// Error(cancelled) if `context` is cancelled meanwhile (the copy is ended), Error(internal) if no
/// process can be made.
std::vector<std::byte> run_in_child(const std::function<std::vector<std::byte>()>& work,
                                    const ChildLimits& limits, const std::string& place, Context& context);

}  // namespace fovea
