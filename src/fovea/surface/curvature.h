#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// Unit normals at the vertices: the mean of the triangles around, weighted as by Max (1999), by the sine of
/// the angle over the lengths of the two edges; exact where the points lie on a sphere, which means by area
/// or angle are not. Zero where there is no area. [#V]. O(#F), parallel.
std::vector<Vec3d> vertex_normals(const Surface& surface, const Adjacency& adjacency, const Context& context);

/// A third of the area of the triangles around each vertex: together the area of the surface. [#V]. O(#F),
/// parallel.
VertexField vertex_areas(const Surface& surface, const Adjacency& adjacency, const Context& context);

/// Mean curvature after Taubin (1995): of the directional curvatures 2 N·(p_j − p_i) / ‖p_j − p_i‖² to the
/// neighbours, the mean by the area of the triangles on the edge. In 1 / length, negative where the surface
/// bulges outward: −1 / R on a sphere, about −1 / 2R on a cylinder. 0 where there is no area. We depart from
/// the paper in the normals, which it takes by area. [#V]. O(#F), parallel.
VertexField mean_curvature(const Surface& surface, const Adjacency& adjacency, const Context& context);

}  // namespace fovea
