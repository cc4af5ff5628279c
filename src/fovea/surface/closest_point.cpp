#include "fovea/surface/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/surface/embree_scene.h"

namespace fovea {

TrianglePoint closest_on_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, {1, 0, 0}};
  const Vec3d bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {b, {0, 1, 0}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double s = d1 - d3 > 0 ? d1 / (d1 - d3) : 0.0;
    return {a + ab * s, {1 - s, s, 0}};
  }
  const Vec3d cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {c, {0, 0, 1}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 - d6 > 0 ? d2 / (d2 - d6) : 0.0;
    return {a + ac * t, {1 - t, 0, t}};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double sum = (d4 - d3) + (d5 - d6);
    const double t = sum > 0 ? (d4 - d3) / sum : 0.0;
    return {b + (c - b) * t, {0, 1 - t, t}};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {a, {1, 0, 0}};
  const double s = vb / sum, t = vc / sum;
  return {a + ab * s + ac * t, {std::max(1 - s - t, 0.0), s, t}};
}

struct ClosestPoint::Tree {
  explicit Tree(const Surface& triangles) : surface(&triangles), scene(triangles) {}

  const Surface* surface;
  EmbreeScene scene;
};

namespace {

struct Query {
  const Surface* surface;
  const EmbreeScene* scene;
  Vec3d p;
  ClosestPoint::Hit best;
};

bool look_at_triangle(RTCPointQueryFunctionArguments* arguments) {
  Query& query = *static_cast<Query*>(arguments->userPtr);
  const auto& t = query.surface->triangles[arguments->primID];
  const auto at = [&](std::uint32_t v) { return Vec3d(query.surface->positions[v]); };
  const TrianglePoint q = closest_on_triangle(query.p, at(t[0]), at(t[1]), at(t[2]));
  const double distance = length(q.point - query.p);
  ClosestPoint::Hit& best = query.best;
  if (distance > best.distance || (distance == best.distance && arguments->primID > best.triangle))
    return false;
  best = {q.point, distance, arguments->primID, q.weights};
  // A little more, so that rounding hides no equally near triangle.
  arguments->query->radius = query.scene->to_tree(distance) * 1.00001f + std::numeric_limits<float>::min();
  return true;
}

}  // namespace

ClosestPoint::ClosestPoint(const Surface& surface) : tree_(std::make_unique<Tree>(surface)) {}
ClosestPoint::~ClosestPoint() = default;
ClosestPoint::ClosestPoint(ClosestPoint&&) noexcept = default;
ClosestPoint& ClosestPoint::operator=(ClosestPoint&&) noexcept = default;

ClosestPoint::Hit ClosestPoint::nearest(Vec3d p) const {
  Query query{tree_->surface, &tree_->scene, p, {{}, std::numeric_limits<double>::infinity(), 0, {}}};
  if (tree_->scene.empty()) return query.best;
  RTCPointQuery point;
  const Vec3f at = tree_->scene.to_tree(p);
  point.x = at.x;
  point.y = at.y;
  point.z = at.z;
  point.time = 0;
  point.radius = std::numeric_limits<float>::infinity();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(tree_->scene.get(), &point, &context, look_at_triangle, &query);
  return query.best;
}

}  // namespace fovea
