#include "fovea/lod/number_code.h"

#include <algorithm>

namespace fovea {

namespace {

/// Integers up to 2 to this are floats.
constexpr int kFloatBits = 24;

}  // namespace

void ScaleFinder::add(float x) {
  if (x == 0) return;
  any_ = true;
  if (of_unit_ && unit_ > 0) {
    const NumberCode code(unit_);
    of_unit_ = std::abs(x) <= 1 && code.number(code.code(x)) == x;
  }
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t mantissa = bits & 0x7FFFFFu;
  const int exponent = static_cast<int>((bits >> 23) & 0xFFu);
  if (exponent == 0 || exponent == 0xFF) {  // too small or no number: no integer of any use
    lowest_ = -1000;
    return;
  }
  lowest_ = std::min(lowest_, exponent - 127 - 23 + (mantissa == 0 ? 23 : std::countr_zero(mantissa)));
  highest_ = std::max(highest_, exponent - 127);
}

double ScaleFinder::scale() const {
  if (!any_) return 1;
  if (unit_ > 0 && of_unit_) return unit_;
  return highest_ - lowest_ < kFloatBits ? std::ldexp(1.0, -lowest_) : 0;
}

}  // namespace fovea
