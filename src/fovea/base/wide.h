#pragma once

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

/// Before the definition of a part of such functions: it becomes one with each of them, so that a machine
/// with AVX2 uses it there and nothing has to be called.
#if defined(__GNUC__)
#define FOVEA_WIDE_PART inline __attribute__((always_inline))
#else
#define FOVEA_WIDE_PART inline
#endif

namespace fovea {

/// Numbers that such functions work on together, as vectors of the language: comparisons give lanes of −1 or
/// 0, for ?: to choose by. To be passed by reference, as machines differ in how else they would be.
constexpr std::size_t kWide = 8;
using WideFloats [[gnu::vector_size(32)]] = float;
using WideInts [[gnu::vector_size(32)]] = std::int32_t;
using WideWords [[gnu::vector_size(32)]] = std::uint32_t;

/// Numbers as vectors of another type: floats without what is behind the point, which must fit.
FOVEA_WIDE_PART void convert(const WideFloats& from, WideInts& to) {
  to = __builtin_convertvector(from, WideInts);
}
FOVEA_WIDE_PART void convert(const WideInts& from, WideFloats& to) {
  to = __builtin_convertvector(from, WideFloats);
}
/// |x|
FOVEA_WIDE_PART void take_sign_off(WideFloats& x) {
  x = reinterpret_cast<WideFloats>(reinterpret_cast<WideInts>(x) & 0x7FFFFFFF);
}

/// Bit i of `out` is what lane i has, which is bit i or nothing.
FOVEA_WIDE_PART void gather_bits(const WideWords& lanes, std::uint32_t& out) {
  using Half [[gnu::vector_size(16)]] = std::uint32_t;
  using Pair [[gnu::vector_size(16)]] = std::uint64_t;
  const Half half =
      __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3) | __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
  const Pair pair = reinterpret_cast<Pair>(half);
  const std::uint64_t both = pair[0] | pair[1];
  out = static_cast<std::uint32_t>(both | both >> 32);
}

/// Lanes by their numbers: out[i] = in[numbers[i]].
FOVEA_WIDE_PART void pick(const WideWords& in, const WideWords& numbers, WideWords& out) {
#if defined(__GNUC__) && !defined(__clang__)
  out = __builtin_shuffle(in, numbers);
#else
  WideWords picked{};
  for (std::size_t i = 0; i < kWide; ++i) picked[i] = in[numbers[i]];
  out = picked;
#endif
}

}  // namespace fovea
