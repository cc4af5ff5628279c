#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/simplify/collapse_state.h"

namespace fovea {

/// How many values of a class are at a and at b, and one of each.
struct ClassEnds {
  std::size_t count_a = 0, count_b = 0;
  std::uint32_t value_a = kInvalid, value_b = kInvalid;

  void add(std::uint32_t value, bool at_b) {
    ++(at_b ? count_b : count_a);
    (at_b ? value_b : value_a) = value;
  }
  /// For texture coordinates, the value that the class must keep so that no texels from beyond its chart
  /// come in: a value that does not join stays; an inner vertex that joins a seam takes the seam's
  /// value; where a seam's sides join they take the value at its end. kInvalid if the class may move:
  /// inside a chart, or along a seam. `many_a` and `many_b`: whether a and b are on a seam.
  std::uint32_t held_value(bool many_a, bool many_b) const {
    if (!many_a && !many_b) return kInvalid;
    if (count_a == 0 || count_b == 0) return count_a == 0 ? value_b : value_a;
    if (count_a != count_b) return count_a > count_b ? value_b : value_a;
    if (many_a != many_b) return many_a ? value_a : value_b;
    return kInvalid;
  }
};

/// Which values of one channel become one when the edge a–b collapses.
///
/// Every triangle on the edge vanishes, and with it the difference between its value at a and its
/// value at b: the two join. On a plain edge that leaves one value; on a seam edge one per side; where
/// a seam ends, the sides join at its end. Values of a or b that no such triangle uses live on.
class ValueClasses {
 public:
  struct Entry {
    std::uint32_t value = kInvalid;
    std::uint32_t root = 0;         ///< Index of the class's first entry.
    std::uint32_t next = kInvalid;  ///< Index of the next entry of the class.
    bool at_b = false;
  };

  /// Finds the classes of `channel` for the edge a–b.
  void find(const CollapseState& state, const Channel& channel, std::uint32_t a, std::uint32_t b);

  std::size_t size() const { return entries_.size(); }
  const Entry& operator[](std::size_t i) const { return entries_[i]; }
  /// Calls f(entry) for the entries of class `root`.
  template <class F>
  void for_class(std::uint32_t root, F&& f) const {
    for (std::uint32_t i = root; i != kInvalid; i = entries_[i].next) f(entries_[i]);
  }
  /// What class `root` of texture coordinates must keep, see ClassEnds; kInvalid for other attributes.
  std::uint32_t held_value(const Channel& channel, std::uint32_t a, std::uint32_t b,
                           std::uint32_t root) const;
  /// Index of the entry of a value that belongs to a or b.
  std::uint32_t index_of(std::uint32_t value) const;

 private:
  std::uint32_t add(std::uint32_t value, bool at_b);
  void join(std::uint32_t i, std::uint32_t j);
  std::size_t slot_of(std::uint32_t value) const;
  void rebuild_table();

  std::vector<Entry> entries_;
  // A pole can have thousands of values: beyond a few, they are found by a hash table (open addressing,
  // entries by index, a power of two in size).
  std::vector<std::uint32_t> table_;
};

}  // namespace fovea
