#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Before the definition of a function whose loops the compiler can turn into vector instructions: it is
/// compiled twice, for machines with AVX2 and for any, and the machine chooses. The same bits either way, as
/// products are not contracted into fused multiply-adds (fovea_floating_point in cmake/FoveaTargets.cmake).
/// Elsewhere, and under sanitizers (they cannot run when the choice is made), it does nothing.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOVEA_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define FOVEA_WIDE
#endif

namespace fovea {

/// Numbers that such functions work on together: loops of fixed length become vector instructions.
constexpr std::size_t kWide = 8;
template <class T>
struct alignas(32) WideArray : std::array<T, kWide> {};
using WideFloats = WideArray<float>;
using WideInts = WideArray<std::int32_t>;
using WideWords = WideArray<std::uint32_t>;

/// The same as vectors of the language, for loops that the compiler does not see through: comparisons give
/// lanes of −1 or 0. Only within functions, as machines differ in how they would be passed.
using FloatLanes [[gnu::vector_size(32)]] = float;
using IntLanes [[gnu::vector_size(32)]] = std::int32_t;
using WordLanes [[gnu::vector_size(32)]] = std::uint32_t;

}  // namespace fovea
