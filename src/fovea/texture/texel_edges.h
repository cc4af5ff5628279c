#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"

// Private to texture.

namespace fovea {

/// The edges between the texels of an image and their 8 neighbours, in the order of their weights: distances
/// of smoothed colours. Each is one number: its weight in fixed point above, below it 4 times the texel plus
/// 0 … 3 for the one to the right, below, below to the right, below to the left. Equal weights are in the
/// order of these numbers.
class TexelEdges {
 public:
  /// O(#texels · σ), parallel; 64 bytes per texel, half of which remain.
  TexelEdges(const Image8& image, double sigma, const Context& context);

  std::vector<std::uint64_t>& keys() { return keys_; }
  std::array<std::uint32_t, 2> ends(std::uint64_t key) const {
    const std::uint64_t number = key & number_mask_;
    const auto texel = static_cast<std::uint32_t>(number / 4);
    return {texel, texel + step_[number % 4]};
  }
  double weight(std::uint64_t key) const { return static_cast<double>(key >> number_bits_) / unit_; }

 private:
  struct Row;
  std::size_t first_edge(int y) const;
  void add_row(int y, const Row& row, std::uint64_t* out) const;

  int width_, height_;
  std::array<std::uint32_t, 4> step_;  // from a texel to the other end
  int number_bits_;
  std::uint64_t number_mask_;
  double unit_;  // that stands for a weight of 1
  std::vector<std::uint64_t> keys_;
};

}  // namespace fovea
