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

/// Which values of one channel become one when an edge a–b collapses.
///
/// Every triangle on the edge vanishes, and with it the difference between its value at a and its
/// value at b: the two join. On a plain edge that leaves one value; on a seam edge one per side; where
/// a seam ends, the sides join at its end.
class JoinedValues {
 public:
  struct Member {
    std::uint32_t value;
    std::uint32_t root;  ///< Index of the first member that it joins with; its own if it is that.
    bool at_b;
  };

  JoinedValues(const Channel& channel, const EdgeCorners& corners) {
    for (std::size_t i = 0; i < corners.count; ++i) {
      const std::uint32_t at_a = channel.corner_value[corners.pairs[i][0]],
                          at_b = channel.corner_value[corners.pairs[i][1]];
      if (at_a == kInvalid || at_b == kInvalid) continue;
      if (count_ == 0) {
        members_[0] = {at_a, 0, false};
        members_[1] = {at_b, 0, true};
        count_ = 2;
      } else if (at_a != members_[0].value || at_b != members_[1].value) {
        join(at_a, at_b);
      }
    }
  }
  std::uint32_t size() const { return count_; }
  const Member& operator[](std::size_t i) const { return members_[i]; }
  /// How many of the values are at a, or at b.
  std::uint32_t count_at(bool b) const {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < count_; ++i) count += members_[i].at_b == b;
    return count;
  }
  bool contains(std::uint32_t value) const {
    bool found = false;
    for (std::uint32_t i = 0; i < count_; ++i) found |= members_[i].value == value;
    return found;
  }

 private:
  void join(std::uint32_t at_a, std::uint32_t at_b);
  std::uint32_t add(std::uint32_t value, bool at_b);

  std::array<Member, 2 * EdgeCorners::kMost> members_;
  std::uint32_t count_ = 0;
};

/// All values of one channel at the ends of an edge, in classes of those that become one. Values that no
/// triangle on the edge uses live on in classes of their own.
class ValueClasses {
 public:
  struct Entry {
    std::uint32_t value = kInvalid;
    std::uint32_t root = 0;         ///< Index of the class's first entry.
    std::uint32_t next = kInvalid;  ///< Index of the next entry of the class.
    bool at_b = false;
    std::uint32_t kept = kInvalid;  ///< At roots, the value that the class becomes: its first at b, if any.
  };

  /// Finds the classes of `channel` for the edge a–b with these corners.
  void find(const CollapseMesh& mesh, const Channel& channel, std::uint32_t a, std::uint32_t b,
            const EdgeCorners& corners);

  std::size_t size() const { return entries_.size(); }
  /// Whether there is one value at a and one at b, which join.
  bool is_one_pair() const { return is_one_pair_; }
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
  std::uint32_t index_of(std::uint32_t value) const {
    if (entries_.size() > kFew) return index_in_table(value);
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
      if (entries_[i].value == value) return i;
    }
    return kInvalid;
  }
  /// The value that `value` becomes.
  std::uint32_t kept_for(std::uint32_t value) const { return entries_[entries_[index_of(value)].root].kept; }

 private:
  /// Up to so many values are searched one after the other.
  static constexpr std::size_t kFew = 16;

  void add_class(std::uint32_t value, bool at_b);
  void add_rest(const CollapseMesh& mesh, const Channel& channel, std::uint32_t v, bool at_b);
  std::uint32_t index_in_table(std::uint32_t value) const;
  std::size_t slot_of(std::uint32_t value) const;
  void rebuild_table();

  std::vector<Entry> entries_;
  bool is_one_pair_ = false;
  // A pole can have thousands of values: beyond a few, they are found by a hash table (open addressing,
  // entries by index, a power of two in size).
  std::vector<std::uint32_t> table_;
};

}  // namespace fovea
