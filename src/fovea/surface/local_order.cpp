#include "fovea/surface/local_order.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace fovea {

namespace {

/// Vertices whose numbers differ by more than this are far apart: so many of the engine fill a first-level
/// cache.
constexpr std::uint32_t kNear = 1024;
/// A mesh whose corners are far from the one before more often than once in so many is put in order.
constexpr std::size_t kMostFar = 8;

bool is_local(const Surface& surface) {
  std::size_t far = 0;
  std::uint32_t last = 0;
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) {
      far += std::max(v, last) - std::min(v, last) > kNear;
      last = v;
    }
  }
  return far * kMostFar <= 3 * surface.triangles.size();
}

/// The ten lowest bits of x, three places apart.
std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | x << 16) & 0x030000FFu;
  x = (x | x << 8) & 0x0300F00Fu;
  x = (x | x << 4) & 0x030C30C3u;
  return (x | x << 2) & 0x09249249u;
}

/// Where each vertex is on a Z-order curve (Morton 1966) through 1024³ cells of the surface's box.
std::vector<std::uint32_t> z_order_codes(const Surface& surface) {
  Box box;
  for (const Vec3f& p : surface.positions) box.add(Vec3d(p));
  const Vec3d size = box.high - box.low;
  const double longest = std::max({size.x, size.y, size.z});
  const double cells = longest > 0 ? 1023 / longest : 0;
  std::vector<std::uint32_t> codes;
  codes.reserve(surface.positions.size());
  for (const Vec3f& p : surface.positions) {
    const Vec3d cell = (Vec3d(p) - box.low) * cells;
    codes.push_back(spread_bits(static_cast<std::uint32_t>(cell.x)) |
                    spread_bits(static_cast<std::uint32_t>(cell.y)) << 1 |
                    spread_bits(static_cast<std::uint32_t>(cell.z)) << 2);
  }
  return codes;
}

/// The numbers 0 … n-1 sorted by their 30-bit keys; equal keys stay in order. O(n).
std::vector<std::uint32_t> sorted_by(const std::vector<std::uint32_t>& keys) {
  constexpr std::uint32_t kDigit = 1 << 10;
  std::vector<std::uint32_t> order(keys.size()), next(keys.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  for (const std::uint32_t shift : {0, 10, 20}) {
    std::array<std::uint32_t, kDigit + 1> first{};
    for (const std::uint32_t key : keys) ++first[(key >> shift) % kDigit + 1];
    for (std::uint32_t digit = 0; digit < kDigit; ++digit) first[digit + 1] += first[digit];
    for (const std::uint32_t i : order) next[first[(keys[i] >> shift) % kDigit]++] = i;
    std::swap(order, next);
  }
  return order;
}

template <class Id>
std::vector<Id> ids_of(const std::vector<std::uint32_t>& numbers) {
  std::vector<Id> ids;
  ids.reserve(numbers.size());
  for (const std::uint32_t n : numbers) ids.push_back(Id{n});
  return ids;
}

template <class Id>
std::vector<Id> all_ids(std::size_t count) {
  std::vector<Id> ids(count);
  for (std::size_t i = 0; i < count; ++i) ids[i] = Id{static_cast<std::uint32_t>(i)};
  return ids;
}

}  // namespace

LocalOrder local_order(const Surface& surface) {
  if (is_local(surface))
    return {all_ids<VertexId>(surface.positions.size()), all_ids<FaceId>(surface.triangles.size())};
  const std::vector<std::uint32_t> vertices = sorted_by(z_order_codes(surface));
  std::vector<std::uint32_t> place(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) place[vertices[i]] = i;
  std::vector<std::uint32_t> first_place;
  first_place.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles)
    first_place.push_back(std::min({place[t[0]], place[t[1]], place[t[2]]}));
  return {ids_of<VertexId>(vertices), ids_of<FaceId>(sorted_by(first_place))};
}

Surface reordered(const Surface& surface, const LocalOrder& order) {
  Surface result;
  result.positions.reserve(order.vertices.size());
  result.triangles.reserve(order.faces.size());
  std::vector<std::uint32_t> place(order.vertices.size());
  for (const VertexId v : order.vertices) {
    place[v.index()] = static_cast<std::uint32_t>(result.positions.size());
    result.positions.push_back(surface.positions[v.index()]);
  }
  for (const FaceId f : order.faces) {
    const auto [a, b, c] = surface.triangles[f.index()];
    result.triangles.push_back({place[a], place[b], place[c]});
  }
  return result;
}

VertexField in_order(const VertexField& field, const LocalOrder& order) {
  VertexField result(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) result.values()[i] = field[order.vertices[i]];
  return result;
}

VertexField in_own_order(const VertexField& field, const LocalOrder& order) {
  VertexField result(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) result[order.vertices[i]] = field.values()[i];
  return result;
}

}  // namespace fovea
