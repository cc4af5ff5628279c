#include "fovea/render/tile.h"

#include <algorithm>
#include <limits>

namespace fovea {

TileSamples::TileSamples(const SampleGrid& grid, int column, int row) : per_pixel_(grid.per_pixel) {
  const int samples = grid.tile_pixels() * grid.per_pixel;
  rect_.left = column * samples;
  rect_.top = row * samples;
  rect_.width = std::min(samples, grid.width * grid.per_pixel - rect_.left);
  rect_.height = std::min(samples, grid.height * grid.per_pixel - rect_.top);
  nearness_.fill(-std::numeric_limits<float>::infinity());
  triangle_.fill(kInvalid);
}

void TileSamples::draw(const ScreenTriangle& triangle) {
  for_spans(triangle.v, rect_, [&](int y, int x0, int x1, const NearnessPlane& plane) {
    float* const nearness = nearness_.data() + index(0, y);
    std::uint32_t* const triangles = triangle_.data() + index(0, y);
    plane.for_row(y, x0, x1, [&](int x, float n) {
      const bool nearer = n > nearness[x];
      nearness[x] = nearer ? n : nearness[x];
      triangles[x] = nearer ? triangle.triangle : triangles[x];
    });
  });
}

void TileSamples::draw_where(const ScreenTriangle& triangle,
                             const std::function<bool(double x, double y)>& keep) {
  for_spans(triangle.v, rect_, [&](int y, int x0, int x1, const NearnessPlane& plane) {
    plane.for_row(y, x0, x1, [&](int x, float n) {
      if (!(n > nearness_[index(x, y)])) return;
      if (!keep((rect_.left + x + 0.5) / per_pixel_, (rect_.top + y + 0.5) / per_pixel_)) return;
      nearness_[index(x, y)] = n;
      triangle_[index(x, y)] = triangle.triangle;
    });
  });
}

void TileSamples::blend(const ScreenTriangle& triangle, std::vector<BlendedSample>& out) const {
  for_spans(triangle.v, rect_, [&](int y, int x0, int x1, const NearnessPlane& plane) {
    plane.for_row(y, x0, x1, [&](int x, float n) {
      if (n > nearness_[index(x, y)])
        out.push_back({static_cast<std::uint32_t>(index(x, y)), n, triangle.triangle});
    });
  });
}

}  // namespace fovea
