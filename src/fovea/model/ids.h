#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace fovea {

/// The index that stands for "none".
inline constexpr std::uint32_t kInvalid = 0xFFFFFFFFu;

/// A 32-bit index that cannot be mistaken for one of another kind. Default: none.
template <class Tag>
struct Id {
  std::uint32_t value = kInvalid;

  constexpr Id() = default;
  explicit constexpr Id(std::size_t index) : value(static_cast<std::uint32_t>(index)) {}
  constexpr bool valid() const { return value != kInvalid; }
  constexpr std::size_t index() const { return value; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

using VertexId = Id<struct VertexTag>;  ///< A geometric point.
using FaceId = Id<struct FaceTag>;      ///< A triangle.
using CornerId = Id<struct CornerTag>;  ///< Corner i (0, 1, 2) of face f is 3 f + i.
using ValueId = Id<struct ValueTag>;    ///< A value of one attribute layer.

constexpr CornerId corner(FaceId f, int i) { return CornerId{3 * f.index() + static_cast<std::size_t>(i)}; }
constexpr FaceId face_of(CornerId c) { return FaceId{c.index() / 3}; }

}  // namespace fovea

template <class Tag>
struct std::hash<fovea::Id<Tag>> {
  std::size_t operator()(fovea::Id<Tag> id) const noexcept { return std::hash<std::uint32_t>{}(id.value); }
};
