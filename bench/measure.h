#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fovea::bench {

/// What a piece of work cost. All zero if it failed.
struct Cost {
  double wall_seconds = 0;
  double cpu_seconds = 0;  ///< User and system time over all threads.
  /// Resident memory at its highest, beyond what was there before; pages of the program are there before.
  std::uint64_t peak_bytes = 0;
  std::uint64_t result = 0;  ///< What the work returned.
};

/// User and system time that this process has used so far, over all threads.
double cpu_seconds();

/// Work in two steps: the outer call prepares (not measured) and returns what is measured. That
/// returns a number that says what came out.
using Work = std::function<std::uint64_t()>;
using Preparation = std::function<Work()>;

/// Prepares and works in a child process of its own, so that nothing earlier weighs on memory or
/// caches, `repeats` times; takes the fastest time and the largest memory.
Cost measure(const Preparation& prepare, int repeats);

/// Runs a program with its output thrown away, `repeats` times; the fastest time and the largest
/// memory of the whole process. Throws Error(input) if it cannot be started or fails; `accepted` are
/// exit codes that count as success beside 0.
Cost measure_command(const std::vector<std::string>& words, int repeats,
                     const std::vector<int>& accepted = {});

}  // namespace fovea::bench
