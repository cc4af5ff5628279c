#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fovea {

/// A set of steps of a simplification, as cards want it: step s is bit s % 32 of word s / 32. [#steps]
class StepBits {
 public:
  explicit StepBits(std::size_t step_count = 0) : words_(step_count / 32 + 1, 0) {}

  bool has(std::size_t s) const { return (words_[s / 32] >> s % 32 & 1u) != 0; }
  void set(std::size_t s, bool value) {
    const std::uint32_t bit = 1u << s % 32;
    words_[s / 32] = value ? words_[s / 32] | bit : words_[s / 32] & ~bit;
  }
  std::span<const std::uint32_t> words() const { return words_; }
  friend bool operator==(const StepBits&, const StepBits&) = default;

 private:
  std::vector<std::uint32_t> words_;
};

}  // namespace fovea
