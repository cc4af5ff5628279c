#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/model/ids.h"

namespace fovea {

/// A number noted for each of a few vertices: a hash table that stays in the fastest cache, where marks in
/// the vertices themselves would have all of them written back to memory.
class VertexNotes {
 public:
  /// Forgets everything, and makes room for `most` vertices.
  void clear(std::size_t most) {
    const std::size_t size = std::bit_ceil(std::max<std::size_t>(2 * most, 64));
    shift_ = 32 - std::countr_zero(size);
    notes_.assign(size, {});
  }
  /// Where `vertex` is or will be, until the notes are cleared.
  std::uint32_t place(std::uint32_t vertex) {
    const auto mask = static_cast<std::uint32_t>(notes_.size()) - 1;
    std::uint32_t at = (vertex * 0x9E3779B1u) >> shift_;
    // Nothing foretells whether a vertex is known; so the loop ends for either reason, and most often at
    // once.
    while (int{notes_[at].vertex != vertex} & int{notes_[at].vertex != kInvalid}) at = (at + 1) & mask;
    notes_[at].vertex = vertex;
    return at;
  }
  /// The number at a place, 0 to begin with.
  std::uint32_t& operator[](std::uint32_t place) { return notes_[place].number; }

 private:
  struct Note {
    std::uint32_t vertex = kInvalid, number = 0;
  };
  std::vector<Note> notes_;  // a power of two, at most half full
  int shift_ = 32;
};

}  // namespace fovea
