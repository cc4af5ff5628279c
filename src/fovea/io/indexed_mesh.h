#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/read.h"
#include "fovea/model/model.h"
#include "fovea/model/weld.h"

namespace fovea {

/// Triangles over separate tables of positions, texture coordinates and normals, as OBJ and PLY hold
/// them. Indices are in range; the reader sees to it.
struct IndexedMesh {
  /// Triangles of one material that all have, or all lack, texture coordinates and normals.
  struct Group {
    int material = -1;
    std::vector<std::uint32_t> positions;  ///< [#triangles × 3]
    std::vector<std::uint32_t> uvs;        ///< [#triangles × 3], or empty if the group has none.
    std::vector<std::uint32_t> normals;    ///< [#triangles × 3], or empty if the group has none.
  };
  std::vector<Vec3f> positions;
  std::vector<Vec2f> uvs;               ///< Origin at the top left.
  std::vector<Vec3f> normals;           ///< Of any length.
  std::vector<VertexArray> attributes;  ///< One value per position; also texture coordinates and normals.
  std::vector<Group> groups;

  std::size_t triangle_count() const;
  std::uint64_t byte_count() const;
};

/// Welds (model/weld.h) with one part per group. `source_vertex` has one entry per position, in
/// their order. Normals come out with length 1; those that have none become the mean of their
/// triangles' ("bad-normals").
///
/// Throws Error(unsupported) if there is no triangle, Error(limit) beyond `max_total_bytes`, and what
/// `weld` throws.
TriMesh weld(IndexedMesh&& mesh, const ReadOptions& options, Context& context, const std::string& place);

/// Gives the normals of a part length 1; those without a direction become the mean of their
/// triangles' ("bad-normals"). Indices must be in range.
void repair_normals(SplitPart& part, Context& context, const std::string& place);

/// A model with one mesh in one node in one scene.
Model model_of(TriMesh&& surface, const std::string& name);

/// Gives parts that lack the texture coordinates which their material's images need a copy of the
/// material without those images: where to look them up is not defined.
void drop_textures_without_uvs(Model& model);

/// Throws Error(limit) with the option's name if one array has more than `options` allow.
void check_element_count(std::uint64_t count, const char* what, const ReadOptions& options,
                         const std::string& place);

}  // namespace fovea
