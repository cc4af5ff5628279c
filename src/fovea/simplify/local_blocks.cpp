#include "fovea/simplify/local_blocks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <vector>

namespace fovea {

namespace {

constexpr WideWords kLaneBits = {1, 2, 4, 8, 16, 32, 64, 128};

/// For each set of lanes, a bit for each: their numbers in order.
constexpr std::array<std::array<std::uint16_t, kWide>, 256> make_lane_lists() {
  std::array<std::array<std::uint16_t, kWide>, 256> lists{};
  for (std::size_t set = 0; set < lists.size(); ++set) {
    std::size_t n = 0;
    for (std::uint16_t i = 0; i < kWide; ++i) {
      if ((set >> i & 1) != 0) lists[set][n++] = i;
    }
  }
  return lists;
}
alignas(64) constexpr auto kLaneLists = make_lane_lists();

}  // namespace

FOVEA_WIDE void lay_face(const WideTriangle& triangle, const RowRange* rows, std::uint32_t face,
                         int first_column, int top, int height, LocalBlock* blocks) {
  const SampleBox box = triangle.box;
  const WideFloats low = WideFloats{} + triangle.plane.low, high = WideFloats{} + triangle.plane.high;
  const WideWords faces = WideWords{} + face;
  const double at_0 = triangle.plane.at_0, dy = triangle.plane.dy;
  const auto [b0, b1, b2] = triangle.b;
  for (int column = box.left / kColumn; column * kColumn < box.right; ++column, ++rows) {
    if (rows->begin >= rows->end) continue;
    const WideInts x = kLanes + column * kColumn;
    const auto words = reinterpret_cast<WideWords>(x);
    const auto y0 = static_cast<std::uint32_t>(rows->begin);
    WideWords edge0 = triangle.a[0] * words + (b0 * y0 + triangle.c[0]);
    WideWords edge1 = triangle.a[1] * words + (b1 * y0 + triangle.c[1]);
    WideWords edge2 = triangle.a[2] * words + (b2 * y0 + triangle.c[2]);
    const WideFloats along = __builtin_convertvector(x, WideFloats) * static_cast<float>(triangle.plane.dx);
    LocalBlock* block = blocks + (column - first_column) * height + (rows->begin - top);
    for (int y = rows->begin; y < rows->end; ++y, ++block) {
      WideFloats nearness = along + static_cast<float>(at_0 + dy * y);
      nearness = nearness < low ? low : nearness;
      nearness = nearness > high ? high : nearness;
      const WideFloats known = block->nearness;
      const WideInts is_inside = reinterpret_cast<WideInts>(edge0 | edge1 | edge2) >= 0;
      const WideInts is_nearer = is_inside & (nearness > known);
      block->nearness = is_nearer ? nearness : known;
      block->face = is_nearer ? faces : block->face;
      edge0 += b0;
      edge1 += b1;
      edge2 += b2;
    }
  }
}

FOVEA_WIDE void clear(LocalBlock* blocks, int count) {
  for (int i = 0; i < count; ++i)
    blocks[i] = {WideFloats{} - std::numeric_limits<float>::infinity(), WideWords{}};
}

FOVEA_WIDE std::size_t find_changes(const BlockColumn& column, std::span<const std::uint32_t> going,
                                    const FoundPixels& found, std::uint32_t* unclear) {
  std::size_t unclear_count = 0;
  const std::uint32_t within = column.width >= kColumn ? 255 : (1u << column.width) - 1;
  const LocalBlock* local = column.locals;
  for (int y = column.begin; y < column.end; ++y, ++local) {
    const FrontBlock& front = column.fronts[y];
    WideInts goes{};
    if (column.changed_by.empty()) {
      for (const std::uint32_t t : going) goes |= front.triangle == t;
    } else {
      for (std::size_t i = 0; i < kWide; ++i) {
        const std::size_t t = std::min<std::size_t>(front.triangle[i], column.changed_by.size() - 1);
        goes[i] = column.changed_by[t] == column.collapse ? -1 : 0;
      }
    }
    const WideFloats nearness = local->nearness;
    const WideFloats bound = goes ? front.second_nearness : front.nearness;
    const WideInts wins = nearness > bound;
    const WideInts asks = ~wins & (goes | ((nearness == bound) & (local->face != 0)));
    std::uint32_t bits = 0;  // those that win, and 8 higher those that ask
    gather_bits((reinterpret_cast<WideWords>(wins) & kLaneBits) |
                    (reinterpret_cast<WideWords>(asks) & (kLaneBits << 8)),
                bits);
    const std::uint32_t pixel = (static_cast<std::uint32_t>(y) << 16) + static_cast<std::uint32_t>(column.x);
    for (std::uint32_t left = bits >> 8 & within; left != 0; left &= left - 1)
      unclear[unclear_count++] = pixel + static_cast<std::uint32_t>(std::countr_zero(left));
    // Face by face, mostly one or two: its pixels all at once, and what is beyond them will be overwritten.
    // There is room for that, as no block before this one has had more than kWide of them.
    for (std::uint32_t left = bits & within; left != 0;) {
      const std::uint32_t face = local->face[std::countr_zero(left)];
      std::uint32_t set = 0;
      gather_bits(reinterpret_cast<WideWords>(local->face == face) & kLaneBits, set);
      set &= left;
      left ^= set;
      using Narrow [[gnu::vector_size(16)]] = std::uint16_t;
      Narrow narrow;
      std::memcpy(&narrow, kLaneLists[set].data(), sizeof(narrow));
      const WideWords lanes = __builtin_convertvector(narrow, WideWords);
      const std::uint32_t at = found.end[face];
      found.end[face] += static_cast<std::uint32_t>(std::popcount(set));
      const WideWords pixels = lanes + pixel;
      std::memcpy(found.pixels + at, &pixels, sizeof(pixels));
      WideWords values;
      pick(front.value, lanes, values);
      std::memcpy(found.before + at, &values, sizeof(values));
      if (column.originals == nullptr) continue;
      std::memcpy(&values, column.originals + static_cast<std::uint32_t>(y) * kWide, sizeof(values));
      pick(values, lanes, values);
      std::memcpy(found.original + at, &values, sizeof(values));
    }
  }
  return unclear_count;
}

FOVEA_WIDE std::size_t keep_different(std::size_t n, std::uint32_t* before, std::uint32_t* after) {
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < n; begin += kWide) {
    WideWords from, to;
    std::memcpy(&from, before + begin, sizeof(from));
    std::memcpy(&to, after + begin, sizeof(to));
    std::uint32_t differ = 0;
    gather_bits(reinterpret_cast<WideWords>(from != to) & kLaneBits, differ);
    if (n - begin < kWide) differ &= (1u << (n - begin)) - 1;
    for (; differ != 0; differ &= differ - 1) {
      const std::size_t k = begin + static_cast<std::size_t>(std::countr_zero(differ));
      before[kept] = before[k];
      after[kept++] = after[k];
    }
  }
  return kept;
}

void mark_inside(std::span<PackedColor> picture, int width, int height) {
  constexpr PackedColor kOpaque = 255, kColors = 0x00FFFFFF;
  const auto at = [width](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  std::vector<std::uint8_t> in_row(picture.size(), 0);  // whether its neighbours in the row are
  for (int y = 0; y < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const PackedColor* const p = &picture[at(x, y)];
      in_row[at(x, y)] = (p[-1] & p[0] & p[1]) >> 24 == kOpaque;
    }
  }
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      if (in_row[at(x, y - 1)] + in_row[at(x, y)] + in_row[at(x, y + 1)] < 3) continue;
      PackedColor& pixel = picture[at(x, y)];
      pixel = (pixel & kColors) | kInside << 24;
    }
  }
}

FOVEA_WIDE std::int64_t added_error(std::size_t n, const std::uint32_t* before, const std::uint32_t* after,
                                    const std::uint32_t* original) {
  std::int64_t sum = 0;
  for (std::size_t begin = 0; begin < n; begin += kWide) {
    const auto count = static_cast<std::int32_t>(std::min(n - begin, kWide));
    std::int32_t part = 0;
    for (std::size_t i = 0; i < kWide; ++i) {
      const std::int32_t more = squared_difference(after[begin + i], original[begin + i]) -
                                squared_difference(before[begin + i], original[begin + i]);
      part += static_cast<std::int32_t>(i) < count ? more : 0;
    }
    sum += part;
  }
  return sum;
}

}  // namespace fovea
