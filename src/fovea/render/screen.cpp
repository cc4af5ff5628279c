#include "fovea/render/screen.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

/// x of a vertex that could not be put on the grid.
constexpr std::int32_t kUnplaced = std::numeric_limits<std::int32_t>::min();
/// Triangles that are sorted into tiles together.
constexpr std::size_t kChunk = 1 << 14;

struct TileRange {
  int x0, x1, y0, y1;  // samples, both ends in
  bool empty() const { return x0 > x1 || y0 > y1; }
};

/// The samples in the box of a triangle.
TileRange samples_in_box(const std::array<ScreenVertex, 3>& v, const SampleGrid& grid) {
  const auto [xl, xh] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [yl, yh] = std::minmax({v[0].y, v[1].y, v[2].y});
  const int half = 1 << (kSubsampleBits - 1);
  const auto first = [&](int low) { return std::max((low + half - 1) >> kSubsampleBits, 0); };
  const auto last = [&](int high, int count) { return std::min((high - half) >> kSubsampleBits, count - 1); };
  return {first(xl), last(xh, grid.width * grid.per_pixel), first(yl),
          last(yh, grid.height * grid.per_pixel)};
}

}  // namespace

/// What one run of triangles puts into the tiles.
struct TileBins::Chunk {
  struct Item {
    std::uint32_t tile, entry;
    bool blended;
  };
  std::vector<Item> items;
  std::vector<ScreenTriangle> clipped;  // entries from triangle_count on, counted in this chunk
};

TileBins::TileBins(const RenderScene& scene, const Projection& projection, const SampleGrid& grid,
                   const Context& context)
    : scene_(scene) {
  project(projection, context);
  const auto count = static_cast<std::size_t>(scene.triangle_count);
  std::vector<Chunk> chunks((count + kChunk - 1) / kChunk);
  parallel_for(context, count, kChunk, [&](std::size_t begin, std::size_t end) {
    sort(projection, grid, begin, end, chunks[begin / kChunk]);
  });
  // Clipped triangles are numbered on after all others.
  for (Chunk& chunk : chunks) {
    const auto before = static_cast<std::uint32_t>(clipped_.size());
    for (Chunk::Item& item : chunk.items) {
      if (item.entry >= count) item.entry += before;
    }
    clipped_.insert(clipped_.end(), chunk.clipped.begin(), chunk.clipped.end());
  }
  const auto tiles = static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows());
  gather(chunks, tiles, false, opaque_);
  gather(chunks, tiles, true, blended_);
}

void TileBins::project(const Projection& projection, const Context& context) {
  vertices_.resize(scene_.meshes.size());
  for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
    const std::vector<Vec3f>& positions = scene_.meshes[m].surface.positions;
    vertices_[m].resize(positions.size());
    parallel_for(context, positions.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (!projection.project(projection.view().to_eye(Vec3d(positions[v])), vertices_[m][v]))
          vertices_[m][v].x = kUnplaced;
      }
    });
  }
}

void TileBins::sort(const Projection& projection, const SampleGrid& grid, std::size_t begin, std::size_t end,
                    Chunk& chunk) const {
  const int tile_samples = grid.tile_pixels() * grid.per_pixel, columns = grid.columns();
  const auto put = [&](const std::array<ScreenVertex, 3>& v, std::uint32_t entry, bool blended) {
    const TileRange range = samples_in_box(v, grid);
    if (range.empty()) return false;
    for (int y = range.y0 / tile_samples; y <= range.y1 / tile_samples; ++y) {
      for (int x = range.x0 / tile_samples; x <= range.x1 / tile_samples; ++x)
        chunk.items.push_back({static_cast<std::uint32_t>(y * columns + x), entry, blended});
    }
    return true;
  };
  std::uint32_t m = origin(scene_, static_cast<std::uint32_t>(begin)).mesh;
  for (std::size_t t = begin; t < end; ++t) {
    while (m + 1 < scene_.meshes.size() && t >= scene_.meshes[m + 1].first_triangle) ++m;
    const SceneMesh& mesh = scene_.meshes[m];
    const std::size_t f = t - mesh.first_triangle;
    const SceneMaterial& material = scene_.materials[mesh.part_material[mesh.mesh->face_part[f]]];
    const bool blended = material.alpha_mode == AlphaMode::blend;
    const auto is_seen = [&](const std::array<ScreenVertex, 3>& v) {
      const std::int64_t area = double_area(v);
      return area != 0 && (material.double_sided || (area > 0) == mesh.surface.mirrored);
    };
    std::array<ScreenVertex, 3> v;
    bool placed = true;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = vertices_[m][mesh.mesh->triangles[f][k].index()];
      placed = placed && v[k].x != kUnplaced;
    }
    if (placed) {
      if (is_seen(v)) put(v, static_cast<std::uint32_t>(t), blended);
      continue;
    }
    std::array<Vec3d, 3> eye;
    for (std::size_t k = 0; k < 3; ++k) {
      eye[k] = projection.view().to_eye(Vec3d(mesh.surface.positions[mesh.mesh->triangles[f][k].index()]));
    }
    const std::vector<ScreenVertex> fan = projection.clip(eye);
    for (std::size_t k = 2; k < fan.size(); ++k) {
      const std::array<ScreenVertex, 3> piece{fan[0], fan[k - 1], fan[k]};
      const auto entry = static_cast<std::uint32_t>(scene_.triangle_count + chunk.clipped.size());
      if (is_seen(piece) && put(piece, entry, blended))
        chunk.clipped.push_back({piece, static_cast<std::uint32_t>(t), m});
    }
  }
}

void TileBins::gather(const std::vector<Chunk>& chunks, std::size_t tiles, bool blended, Lists& lists) const {
  lists.first.assign(tiles + 1, 0);
  for (const Chunk& chunk : chunks) {
    for (const Chunk::Item& item : chunk.items) lists.first[item.tile + 1] += item.blended == blended;
  }
  for (std::size_t tile = 0; tile < tiles; ++tile) lists.first[tile + 1] += lists.first[tile];
  lists.entries.resize(lists.first.back());
  std::vector<std::uint32_t> at(lists.first.begin(), lists.first.end() - 1);
  for (const Chunk& chunk : chunks) {
    for (const Chunk::Item& item : chunk.items) {
      if (item.blended == blended) lists.entries[at[item.tile]++] = item.entry;
    }
  }
}

ScreenTriangle TileBins::at(std::uint32_t entry) const {
  if (entry >= scene_.triangle_count) return clipped_[entry - scene_.triangle_count];
  const TriangleOrigin from = origin(scene_, entry);
  const auto& t = scene_.meshes[from.mesh].mesh->triangles[from.face.index()];
  const std::vector<ScreenVertex>& vertices = vertices_[from.mesh];
  return {{vertices[t[0].index()], vertices[t[1].index()], vertices[t[2].index()]}, entry, from.mesh};
}

}  // namespace fovea
