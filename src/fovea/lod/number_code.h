#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <span>

// Private to lod.

namespace fovea {

/// Turns numbers into integers that lie close together where the numbers do, and back without loss: multiples
/// of 1 / scale into how many of them, or, with scale 0, any floats into their place in the order of all
/// floats.
class NumberCode {
 public:
  explicit NumberCode(double scale = 0) : scale_(scale) {}
  double scale() const { return scale_; }

  std::int32_t code(float x) const {
    if (scale_ > 0) return static_cast<std::int32_t>(std::lround(static_cast<double>(x) * scale_));
    return flipped(std::bit_cast<std::int32_t>(x));
  }
  float number(std::int32_t code) const {
    if (scale_ > 0) return static_cast<float>(static_cast<double>(code) / scale_);
    return std::bit_cast<float>(flipped(code));
  }
  /// The code of what lies as far from `middle` as `a`, on the other side.
  std::int32_t opposite(std::int32_t middle, std::int32_t a) const {
    if (scale_ > 0)
      return static_cast<std::int32_t>(2u * static_cast<std::uint32_t>(middle) -
                                       static_cast<std::uint32_t>(a));
    return code(static_cast<float>(2 * static_cast<double>(number(middle)) - static_cast<double>(number(a))));
  }

 private:
  /// Negative floats have their magnitude turned round, so that order is that of integers.
  static std::int32_t flipped(std::int32_t bits) { return bits < 0 ? bits ^ 0x7FFFFFFF : bits; }

  double scale_;
};

/// The sizes of integers that `numbers` are multiples of: finds a scale for NumberCode that fits all that
/// were added.
class ScaleFinder {
 public:
  /// `unit`: the number that integers of this kind stand for fractions of (255 for normalised bytes); 0 if
  /// none.
  explicit ScaleFinder(int unit = 0) : unit_(unit) {}
  void add(float x);
  void add(std::span<const float> numbers) {
    for (const float x : numbers) add(x);
  }
  /// 0 if there is none.
  double scale() const;

 private:
  int unit_;
  bool of_unit_ = true;  // all are whole numbers of 1 / unit
  int lowest_ = 1000;    // the lowest bit that is set in any,
  int highest_ = -1000;  // and the highest: exponents of 2
  bool any_ = false;
};

}  // namespace fovea
