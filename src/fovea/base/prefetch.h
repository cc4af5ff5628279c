#pragma once

namespace fovea {

/// Starts to load the cache line at `p`, for memory that is about to be needed. Only a hint: any
/// address is allowed, and on compilers that do not know how nothing happens.
inline void prefetch([[maybe_unused]] const void* p) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(p);
  asm volatile(
      "");  // else GCC 12 takes functions that do nothing but prefetch for pure, and leaves out their calls
#endif
}

}  // namespace fovea
