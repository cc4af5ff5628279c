#include "fovea/cluster/connect.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "fovea/model/ids.h"
#include "fovea/surface/disjoint_sets.h"

namespace fovea {

namespace {

/// Of the edge that two triangles share; 0 if they are linked by a bridge.
double shared_length(const Surface& surface, std::uint32_t f, std::uint32_t g) {
  const auto& b = surface.triangles[g];
  std::vector<std::uint32_t> common;
  for (const std::uint32_t v : surface.triangles[f]) {
    if (std::find(b.begin(), b.end(), v) != b.end()) common.push_back(v);
  }
  return common.size() < 2 ? 0 : length(surface.position(common[0]) - surface.position(common[1]));
}

/// What a piece shares with a cluster beside it.
struct Border {
  std::uint32_t piece = 0, cluster = 0;
  double length = 0;
  std::uint32_t links = 0;
};

class Pieces {
 public:
  Pieces(const ClusterGround& ground, std::vector<std::uint32_t>& of_face, std::size_t count)
      : ground_(ground), of_face_(of_face), sets_(of_face.size()), stays_(of_face.size(), 0) {
    for (std::uint32_t f = 0; f < of_face.size(); ++f) {
      for (const DualGraph::Link& link : ground.graph.around(f)) {
        if (link.face < f && of_face[link.face] == of_face[f]) sets_.unite(link.face, f);
      }
    }
    keep_largest(count);
    for (std::uint32_t f = 0; f < of_face.size(); ++f) {
      if (!stays_[sets_.find(f)]) loose_.push_back(f);
    }
  }

  /// Lets those beside what stays join it; returns whether others are left.
  bool join() {
    const std::vector<Border> borders = borders_of_loose();
    for (std::size_t i = 0; i < borders.size(); ++i) {
      if (i > 0 && borders[i].piece == borders[i - 1].piece) continue;
      stays_[borders[i].piece] = 1;
      of_face_[borders[i].piece] = borders[i].cluster;
    }
    std::erase_if(loose_, [&](std::uint32_t f) {
      const std::uint32_t piece = sets_.find(f);
      if (stays_[piece]) of_face_[f] = of_face_[piece];
      return stays_[piece] != 0;
    });
    return !loose_.empty();
  }

 private:
  void keep_largest(std::size_t count) {
    std::vector<double> area(of_face_.size(), 0);
    for (std::size_t f = 0; f < of_face_.size(); ++f)
      area[sets_.find(f)] += static_cast<double>(ground_.graph.areas[f]);
    std::vector<std::uint32_t> largest(count, kInvalid);
    for (std::uint32_t f = 0; f < of_face_.size(); ++f) {
      std::uint32_t& best = largest[of_face_[f]];
      if (sets_.find(f) == f && (best == kInvalid || area[f] > area[best])) best = f;
    }
    for (const std::uint32_t f : largest) stays_[f] = 1;
  }

  /// Between loose pieces and clusters beside them that stay, the best of each piece first.
  std::vector<Border> borders_of_loose() {
    std::vector<Border> found;
    for (const std::uint32_t f : loose_) {
      for (const DualGraph::Link& link : ground_.graph.around(f)) {
        if (stays_[sets_.find(link.face)])
          found.push_back(
              {sets_.find(f), of_face_[link.face], shared_length(ground_.surface, f, link.face), 1});
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const Border& a, const Border& b) {
      return std::pair(a.piece, a.cluster) < std::pair(b.piece, b.cluster);
    });
    std::vector<Border> sums;
    for (const Border& border : found) {
      if (sums.empty() || sums.back().piece != border.piece || sums.back().cluster != border.cluster) {
        sums.push_back(border);
      } else {
        sums.back().length += border.length;
        ++sums.back().links;
      }
    }
    std::sort(sums.begin(), sums.end(), [](const Border& a, const Border& b) {
      return std::tuple(a.piece, -a.length, b.links, a.cluster) <
             std::tuple(b.piece, -b.length, a.links, b.cluster);
    });
    return sums;
  }

  const ClusterGround& ground_;
  std::vector<std::uint32_t>& of_face_;
  DisjointSets sets_;                 // triangles by piece
  std::vector<char> stays_;           // of a piece's first triangle
  std::vector<std::uint32_t> loose_;  // triangles of other pieces
};

}  // namespace

void connect(const ClusterGround& ground, std::vector<std::uint32_t>& of_face, std::size_t count) {
  Pieces pieces(ground, of_face, count);
  while (pieces.join()) {
  }
}

}  // namespace fovea
