#include "fovea/surface/facing_point.h"

#include <cmath>
#include <limits>
#include <utility>

#include "fovea/surface/embree_scene.h"

namespace fovea {

namespace {

/// Cosine of the angle between normals that still face the same way.
constexpr double kFacing = 0.25;

}  // namespace

struct FacingPoint::Tree {
  Tree(const Surface& triangles, std::vector<std::uint32_t> of)
      : surface(&triangles), kinds(std::move(of)), scene(triangles, [](RTCGeometry geometry) {
          rtcSetGeometryIntersectFilterFunction(geometry, look_at_hit);
        }) {
    normals.reserve(triangles.triangles.size());
    for (const auto& t : triangles.triangles) {
      const Vec3d a = triangles.position(t[0]);
      normals.emplace_back(normalized(cross(triangles.position(t[1]) - a, triangles.position(t[2]) - a)));
    }
  }

  /// A question and the best answer so far.
  struct Search {
    const Tree* tree;
    Query query;
    ClosestPoint::Hit best;

    bool is_like(std::uint32_t triangle) const {
      return tree->kinds[triangle] == query.kind &&
             dot(Vec3d(tree->normals[triangle]), query.normal) > kFacing;
    }
    TrianglePoint closest(std::uint32_t triangle, Vec3d p) const {
      const auto& t = tree->surface->triangles[triangle];
      return closest_on_triangle(p, tree->surface->position(t[0]), tree->surface->position(t[1]),
                                 tree->surface->position(t[2]));
    }
    bool offer(std::uint32_t triangle, double distance, const TrianglePoint& at) {
      if (distance > best.distance || (distance == best.distance && triangle > best.triangle)) return false;
      best = {at.point, distance, triangle, at.weights};
      return true;
    }
    std::optional<ClosestPoint::Hit> result() const {
      return best.triangle == kInvalid ? std::nullopt : std::optional(best);
    }
  };
  Search search(const Query& query) const { return {this, query, {{}, query.most, kInvalid, {}}}; }

  struct RayContext {
    RTCIntersectContext context;  // the first member: Embree gives back this one
    Search* search;
  };

  /// Takes no hit, so that the ray sees all; distances are found again in double precision.
  static void look_at_hit(const RTCFilterFunctionNArguments* arguments) {
    arguments->valid[0] = 0;
    Search& search = *reinterpret_cast<RayContext*>(arguments->context)->search;
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, 1, 0);
    if (!search.is_like(triangle)) return;
    const Vec3d normal(search.tree->normals[triangle]);
    const Vec3d corner = search.tree->surface->position(search.tree->surface->triangles[triangle][0]);
    const double along = dot(corner - search.query.point, normal) / dot(search.query.normal, normal);
    search.offer(triangle, std::abs(along),
                 search.closest(triangle, search.query.point + search.query.normal * along));
  }

  static bool look_at_triangle(RTCPointQueryFunctionArguments* arguments) {
    Search& search = *static_cast<Search*>(arguments->userPtr);
    if (!search.is_like(arguments->primID)) return false;
    const TrianglePoint at = search.closest(arguments->primID, search.query.point);
    const double distance = length(at.point - search.query.point);
    if (!search.offer(arguments->primID, distance, at)) return false;
    // A little more, so that rounding hides no equally near triangle.
    arguments->query->radius =
        search.tree->scene.to_tree(distance) * 1.00001f + std::numeric_limits<float>::min();
    return true;
  }

  const Surface* surface;
  std::vector<std::uint32_t> kinds;
  std::vector<Vec3f> normals;
  EmbreeScene scene;
};

FacingPoint::FacingPoint(const Surface& surface, std::vector<std::uint32_t> kinds)
    : tree_(std::make_unique<Tree>(surface, std::move(kinds))) {}
FacingPoint::~FacingPoint() = default;
FacingPoint::FacingPoint(FacingPoint&&) noexcept = default;
FacingPoint& FacingPoint::operator=(FacingPoint&&) noexcept = default;

std::optional<ClosestPoint::Hit> FacingPoint::along_normal(const Query& query) const {
  Tree::Search search = tree_->search(query);
  if (tree_->scene.empty()) return {};
  const Vec3f from = tree_->scene.to_tree(query.point - query.normal * query.most), along(query.normal);
  RTCRayHit ray{};
  ray.ray.org_x = from.x;
  ray.ray.org_y = from.y;
  ray.ray.org_z = from.z;
  ray.ray.dir_x = along.x;
  ray.ray.dir_y = along.y;
  ray.ray.dir_z = along.z;
  ray.ray.tfar = tree_->scene.to_tree(2 * query.most);
  ray.ray.mask = 0xFFFFFFFF;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Tree::RayContext context{{}, &search};
  rtcInitIntersectContext(&context.context);
  rtcIntersect1(tree_->scene.get(), &context.context, &ray);
  return search.result();
}

std::optional<ClosestPoint::Hit> FacingPoint::nearest(const Query& query) const {
  Tree::Search search = tree_->search(query);
  if (tree_->scene.empty()) return {};
  RTCPointQuery point;
  const Vec3f at = tree_->scene.to_tree(query.point);
  point.x = at.x;
  point.y = at.y;
  point.z = at.z;
  point.time = 0;
  point.radius = tree_->scene.to_tree(query.most) * 1.00001f;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(tree_->scene.get(), &point, &context, Tree::look_at_triangle, &search);
  return search.result();
}

}  // namespace fovea
