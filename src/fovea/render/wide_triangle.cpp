#include "fovea/render/wide_triangle.h"

namespace fovea {

/// Cuts the triangle at the borders of columns, kWide of these at a time.
FOVEA_WIDE void find_rows(const std::array<ScreenVertex, 3>& v, const SampleBox& box, RowRange* out) {
  constexpr std::int32_t kSide = kColumn * kSubsamples, kHalf = kSubsamples / 2;
  constexpr float kFar = 1 << 30;
  const int first = box.left / kColumn, count = (box.right - 1) / kColumn - first + 1;
  for (int begin = 0; begin < count; begin += kColumn) {
    WideFloats left, lowest = WideFloats{} + kFar, highest = WideFloats{} - kFar;
    // Counted from a corner, so that nothing is rounded by much.
    const WideInts start = (kLanes + (first + begin)) * kSide - v[0].x;
    convert(start, left);
    const WideFloats right = left + static_cast<float>(kSide);
    for (std::size_t k = 0; k < 3; ++k) {
      const ScreenVertex &p = v[k], &q = v[(k + 1) % 3];
      const auto px = static_cast<float>(p.x - v[0].x), py = static_cast<float>(p.y - v[0].y);
      const auto dx = static_cast<float>(q.x - p.x), dy = static_cast<float>(q.y - p.y);
      const float low_x = std::min(px, px + dx), high_x = std::max(px, px + dx);
      const float slope = dx != 0 ? dy / dx : 0;
      const WideFloats from = left > low_x ? left : low_x, to = right < high_x ? right : high_x;
      // An upright edge has its corners in other edges, too.
      const WideFloats at_from = py + (from - px) * slope, at_to = py + (to - px) * slope;
      const WideInts is_there = from <= to;
      const WideFloats low = at_from < at_to ? at_from : at_to, high = at_from < at_to ? at_to : at_from;
      lowest = (is_there & (low < lowest)) ? low : lowest;
      highest = (is_there & (high > highest)) ? high : highest;
    }
    constexpr std::int32_t kMargin = 4;  // more than is rounded
    WideInts low, high;
    convert(lowest, low);
    convert(highest, high);
    low = (low + (v[0].y - kHalf - kMargin)) >> kSubsampleBits;
    high = ((high + (v[0].y - kHalf + kMargin)) >> kSubsampleBits) + 1;
    low = low > box.top ? low : box.top;
    high = high < box.bottom ? high : box.bottom;
    for (int i = 0; i < std::min(count - begin, kColumn); ++i) out[begin + i] = {low[i], high[i]};
  }
}

}  // namespace fovea
