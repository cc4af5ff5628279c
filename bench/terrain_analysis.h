#pragma once

// What marginal analysis finds of all pairs of a mesh and a texture, for terrain_bench.

#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fovea/budget/marginal.h"
#include "fovea/model/model.h"
#include "fovea/texture/mip_map.h"

namespace fovea::bench {

/// What a mesh or a texture takes, and what it is.
struct MeshRung {
  Model model;
  std::uint64_t bytes = 0;
};
struct TextureRung {
  std::shared_ptr<const MipMap> map;
  std::uint64_t bytes = 0;
  double kept = 0;  ///< Of the coefficients or texels.
};
struct Ladders {
  std::string name;
  std::vector<MeshRung> meshes;
  std::vector<TextureRung> textures;
};

using Path = std::vector<JointPoint>;

/// A way through the pairs, and those that were drawn for it.
struct Way {
  std::string name;
  Path path, drawn;
};

/// All pairs of two ladders, their lower hull, and the ways that lead down or up.
class TerrainAnalysis {
 public:
  /// `losses` [#meshes][#textures]: mean squared differences.
  TerrainAnalysis(const Ladders& ladders, std::vector<std::vector<double>> losses);
  /// How many pairs each way draws and how far it stays behind, as Markdown.
  void print() const;
  /// Pairs of about the bytes of the best one within `part` of the largest: this one, and those that give
  /// most to the texture and to the mesh (figure 6 of the paper).
  std::array<std::pair<std::string, JointPoint>, 3> trades(double part) const;
  /// Every pair as CSV, with the ways that pass it.
  void write_points(std::ofstream& out, const std::string& land) const;

 private:
  void add(std::string name, const std::function<Path()>& walk);

  const Ladders& ladders_;
  std::vector<std::vector<double>> losses_;
  JointLadders joint_;
  std::set<Rungs> asked_;
  Path all_, hull_;
  std::vector<Way> ways_;
};

}  // namespace fovea::bench
