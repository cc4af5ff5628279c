#include "fovea/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"

namespace fovea {

namespace {

constexpr std::size_t kNeighborGrain = 1 << 13;

/// Counts per item to where each item's list begins; one more at the end.
void add_up(std::vector<std::uint32_t>& counts) {
  std::uint32_t sum = 0;
  for (std::uint32_t& c : counts) c = std::exchange(sum, sum + c);
}

}  // namespace

Surface surface_of(const TriMesh& mesh) {
  Surface surface;
  surface.positions = mesh.positions;
  surface.triangles.reserve(mesh.face_count());
  for (const auto& t : mesh.triangles) surface.triangles.push_back({t[0].value, t[1].value, t[2].value});
  return surface;
}

void append(Surface& surface, const TriMesh& mesh, std::span<const Vec3f> positions, bool turned) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  surface.positions.insert(surface.positions.end(), positions.begin(), positions.end());
  for (const auto& t : mesh.triangles) {
    auto& added = surface.triangles.emplace_back(
        std::array{first + t[0].value, first + t[1].value, first + t[2].value});
    if (turned) std::swap(added[1], added[2]);
  }
}

double diagonal(const Surface& surface) {
  Box box;
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) box.add(surface.position(v));
  }
  return surface.triangles.empty() ? 0 : box.diagonal();
}

double unit_scale(const Surface& surface) {
  const double d = diagonal(surface);
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3f p = surface.positions[v];
      if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
        throw Error(ErrorKind::unsupported, "a corner of a triangle lies beyond what floats hold", {},
                    "make the model smaller");
    }
  }
  return d > 0 ? std::ldexp(1.0, -std::ilogb(d)) : 1;
}

void scale(Surface& surface, double factor) {
  constexpr double kMost = std::numeric_limits<float>::max();
  const auto scaled = [&](float x) {
    return static_cast<float>(std::clamp(factor * static_cast<double>(x), -kMost, kMost));
  };
  for (Vec3f& p : surface.positions) p = {scaled(p.x), scaled(p.y), scaled(p.z)};
}

Adjacency::Adjacency(const Surface& surface, const Context& context) {
  const std::size_t count = surface.positions.size();
  first_corner_.assign(count + 1, 0);
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) ++first_corner_[v];
  }
  add_up(first_corner_);
  corners_.resize(3 * surface.triangles.size());
  std::vector<std::uint32_t> at(first_corner_.begin(), first_corner_.end() - 1);
  for (std::uint32_t c = 0; c < corners_.size(); ++c) corners_[at[surface.triangles[c / 3][c % 3]]++] = c;

  // Twice over: how many, then which.
  const auto for_neighbors = [&](auto&& f) {
    parallel_for(context, count, kNeighborGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> found;
      for (std::size_t v = begin; v < end; ++v) {
        found.clear();
        for (const std::uint32_t c : corners(static_cast<std::uint32_t>(v))) {
          const auto& triangle = surface.triangles[c / 3];
          found.push_back(triangle[(c + 1) % 3]);
          found.push_back(triangle[(c + 2) % 3]);
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        f(v, found);
      }
    });
  };
  first_neighbor_.assign(count + 1, 0);
  for_neighbors([&](std::size_t v, const std::vector<std::uint32_t>& found) {
    first_neighbor_[v] = static_cast<std::uint32_t>(found.size());
  });
  add_up(first_neighbor_);
  neighbors_.resize(first_neighbor_.back());
  for_neighbors([&](std::size_t v, const std::vector<std::uint32_t>& found) {
    std::copy(found.begin(), found.end(), neighbors_.begin() + first_neighbor_[v]);
  });
}

}  // namespace fovea
