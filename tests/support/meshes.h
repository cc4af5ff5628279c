#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fovea/model/model.h"
#include "fovea/model/tri_mesh.h"
#include "fovea/model/weld.h"

/// Hand-built minimal meshes: one per family of trouble. All go through `weld`, as files do; figures
/// are in the .cpp. Triangles are counter-clockwise seen from +z (flat meshes) or from outside.
namespace fovea::test {

/// Adds vertices and triangles to a SplitPart whose layers are uv and, on request, normals.
class PartBuilder {
 public:
  explicit PartBuilder(int material = -1, bool with_uv = true, bool with_normals = false);
  std::uint32_t vertex(Vec3f position, Vec2f uv = {}, Vec3f normal = {0, 0, 1});
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// a b c d counter-clockwise, cut along a-c.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  std::uint32_t size() const { return static_cast<std::uint32_t>(part_.positions.size()); }
  SplitPart& part() { return part_; }

 private:
  SplitPart part_;
};

/// Welds parts without letting anybody hear the diagnostics.
TriMesh weld_parts(std::vector<SplitPart> parts);
TriMesh weld_part(SplitPart part);

/// No parts, no faces.
TriMesh empty_mesh();
/// One triangle with uv.
TriMesh single_triangle();
/// V 4, F 4, closed, no layers.
TriMesh tetrahedron();
/// [-1, 1]³: V 8, F 12, closed. Every side has its own uv chart and flat normals, so that each of the
/// 12 cube edges is a seam of both layers, and the 6 diagonals are not.
TriMesh cube();
/// [0, 1]² at z = 0 in columns × rows quads: V (columns + 1)(rows + 1), F 2 columns rows. uv = (x, y),
/// normals +z, no seams.
TriMesh grid(int columns, int rows);
/// As `grid`, but z = amplitude · sin(2πx) · sin(2πy); normals of that surface.
TriMesh wavy_grid(int columns, int rows, double amplitude);
/// As `grid`, in two parts with materials 0 (left) and 1 (right of the middle column); `columns` is
/// even. The two share positions along the border, and uv values by bits but not by part.
TriMesh two_part_grid(int columns, int rows);
/// Radius 1, axis z, height 2, open at both ends: V around · (along + 1), F 2 around along. u runs
/// once around: the line at angle 0 is a seam with `along` edges. Smooth normals, no seam of theirs.
TriMesh open_cylinder(int around, int along);
/// Icosahedron with each triangle cut in four `subdivisions` times, on the unit sphere: V 10·4ⁿ + 2,
/// F 20·4ⁿ. Smooth normals, no uv.
TriMesh icosphere(int subdivisions);
/// (major, minor) torus in around × across quads with a uv seam in both directions: Euler number 0.
TriMesh torus(int around, int across);
/// Strip of 2 · half quads whose uv is mirrored about its middle column. Both halves use the same uv
/// values there; `weld` makes a seam of that column, as the texture turns over.
TriMesh mirrored_strip(int half);
/// Two triangles that share one vertex and nothing else.
TriMesh bow_tie();
/// Three triangles on one edge.
TriMesh non_manifold_edge();
/// Two triangles on one edge that run through it in the same direction.
TriMesh inconsistent_edge();
/// One good triangle, one with an index twice, one with two equal positions: after `weld` F 1.
SplitPart degenerate_part();
/// A triangle given twice: F 2, every edge with two triangles of the same direction.
TriMesh duplicate_faces();
/// A triangle given once each way: F 2, V 3, closed.
TriMesh two_sided_triangle();
/// Strip along x of `quads` quads, joints (0, 1) with weights going linearly from (1, 0) to (0, 1).
TriMesh skinned_strip(int quads);
/// Strip along x of `quads` quads with two targets: the first lifts each vertex by x² in z and tilts
/// its normal, the second moves only uv.
TriMesh morph_strip(int quads);
/// A mesh far too thin: a strip of quads with height 1e-7 of its length.
TriMesh sliver_strip(int quads);
/// `count` tetrahedra of sizes 1, 1/2, 1/4, ... beside each other.
TriMesh tetrahedra(int count);

struct NamedMesh {
  std::string name;
  TriMesh mesh;
};
/// One of each, for tests that hold for any mesh.
std::vector<NamedMesh> all_families();

/// The same mesh with vertices, triangles and values in random order, as scans and exports have them.
TriMesh shuffled(const TriMesh& mesh);
/// About the origin.
TriMesh scaled(TriMesh mesh, float scale);

/// A model that shows each mesh once, in one scene; materials as many as the parts name.
Model model_of(std::vector<TriMesh> meshes);
Model model_of(TriMesh mesh);

/// Model with two joints, a bending animation and `skinned_strip`.
Model skinned_model(int quads);

}  // namespace fovea::test
