#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "fovea/base/math.h"

namespace fovea {

/// A quadratic function of a point: p ↦ pᵀ A p + 2 b·p + c, with A symmetric (Garland & Heckbert
/// 1997). Sums of weighted squared distances to planes and points have this form. `weight` is the
/// sum of those weights (importance aside), so that sqrt(value / weight) is a root-mean-square distance.
/// Aligned so that one does not lie on three cache lines.
struct alignas(32) Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  double bx = 0, by = 0, bz = 0;
  double c = 0;
  double weight = 0;

  Quadric& operator+=(const Quadric& q) {
    xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
    bx += q.bx, by += q.by, bz += q.bz;
    c += q.c;
    weight += q.weight;
    return *this;
  }
  friend Quadric operator+(const Quadric& a, const Quadric& b) {
    Quadric sum = a;
    return sum += b;
  }

  /// Adds w · q; its weight is that of q, whatever w.
  void add_scaled(const Quadric& q, double w) {
    xx += w * q.xx, xy += w * q.xy, xz += w * q.xz, yy += w * q.yy, yz += w * q.yz, zz += w * q.zz;
    bx += w * q.bx, by += w * q.by, bz += w * q.bz;
    c += w * q.c;
    weight += q.weight;
  }
  /// Adds w · (g·p + d)²: for unit g the squared distance to a plane, for a gradient g the squared
  /// deviation of an attribute from zero.
  void add_linear(Vec3d g, double d, double w) {
    xx += w * g.x * g.x, xy += w * g.x * g.y, xz += w * g.x * g.z;
    yy += w * g.y * g.y, yz += w * g.y * g.z, zz += w * g.z * g.z;
    bx += w * d * g.x, by += w * d * g.y, bz += w * d * g.z;
    c += w * d * d;
  }
  /// Adds w · ‖p − q‖².
  void add_point(Vec3d q, double w) {
    xx += w, yy += w, zz += w;
    bx -= w * q.x, by -= w * q.y, bz -= w * q.z;
    c += w * dot(q, q);
  }
  double value(Vec3d p) const {
    return p.x * (xx * p.x + 2 * (xy * p.y + xz * p.z + bx)) + p.y * (yy * p.y + 2 * (yz * p.z + by)) +
           p.z * (zz * p.z + 2 * bz) + c;
  }

  /// The value at the point that `minimum` found, for less: there A p = -b.
  double value_at_minimum(Vec3d p) const { return bx * p.x + by * p.y + bz * p.z + c; }

  /// The point of least value. Returns false if A is singular to working precision (`limit` bounds
  /// the determinant against the cube of A's trace).
  bool minimum(Vec3d& p, double limit = 1e-13) const {
    const double m00 = yy * zz - yz * yz, m01 = xz * yz - xy * zz, m02 = xy * yz - xz * yy;
    const double det = xx * m00 + xy * m01 + xz * m02;
    const double trace = xx + yy + zz;
    if (!(det > limit * trace * trace * trace)) return false;
    const double m11 = xx * zz - xz * xz, m12 = xy * xz - xx * yz, m22 = xx * yy - xy * xy;
    const double s = -1 / det;
    p = {s * (m00 * bx + m01 * by + m02 * bz), s * (m01 * bx + m11 * by + m12 * bz),
         s * (m02 * bx + m12 * by + m22 * bz)};
    return true;
  }
};

/// A Quadric as a function of the way from its vertex, in single precision. Near the surface all its terms
/// are small, so that what floats lose is far below the pull towards the original vertices (kRegularization
/// in collapse_state.cpp); around a point far away they would lose everything.
struct VertexQuadric {
  /// In the order of Quadric's members.
  std::array<float, 11> numbers{};

  VertexQuadric() = default;
  /// `q`, for a vertex at `at`.
  VertexQuadric(Quadric q, Vec3d at) {
    move(q, at);
    set(q);
  }
  float weight() const { return numbers[10]; }
  /// As a function of points, of a vertex at `at`.
  Quadric around_origin(Vec3d at) const {
    Quadric q = get();
    move(q, -at);
    return q;
  }
  /// Adds w · q, a function of the way from the vertex as well; its weight is that of q, whatever w.
  void add_scaled(const Quadric& q, double w) {
    Quadric sum = get();
    sum.add_scaled(q, w);
    set(sum);
  }

 private:
  Quadric get() const {
    std::array<double, 11> q;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = static_cast<double>(numbers[i]);
    return {q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7], q[8], q[9], q[10]};
  }
  void set(const Quadric& q) {
    const std::array<double, 11> all{q.xx, q.xy, q.xz, q.yy, q.yz, q.zz, q.bx, q.by, q.bz, q.c, q.weight};
    for (std::size_t i = 0; i < all.size(); ++i) numbers[i] = static_cast<float>(all[i]);
  }
  /// p ↦ q(p + by)
  static void move(Quadric& q, Vec3d by) {
    const Vec3d b{q.bx + q.xx * by.x + q.xy * by.y + q.xz * by.z,
                  q.by + q.xy * by.x + q.yy * by.y + q.yz * by.z,
                  q.bz + q.xz * by.x + q.yz * by.y + q.zz * by.z};
    q.c += (q.bx + b.x) * by.x + (q.by + b.y) * by.y + (q.bz + b.z) * by.z;
    q.bx = b.x, q.by = b.y, q.bz = b.z;
  }
};

/// The part of an attribute's quadric that depends on its value (Hoppe 1999, eq. 8–12). With s the
/// value of one component at the vertex, the summed squared deviations from the linear functions
/// g·p + d of the triangles around are
///   Σ w (g·p + d − s)² = Σ w (g·p + d)² − 2 s (G·p + D) + W s²,   G = Σ w g,  D = Σ w d,  W = Σ w.
/// The first term goes into the vertex's Quadric. Minimised over s (s = (G·p + D) / W) the rest is
/// −(G·p + D)² / W.
///
/// In memory: `width` times (G, D), then W; see `attribute_stride`. The engine keeps floats: attributes are
/// scaled to a few hundredths of the diagonal at most (collapse_state.cpp), so that what they lose is a
/// few hundred-thousandths of it, as a distance.
constexpr std::size_t attribute_stride(int width) { return 4 * static_cast<std::size_t>(width) + 1; }

/// Subtracts Σ_k (G_k·p + D_k)² / W from q: the value of each component is the best for p. With
/// `times` −1 it takes that back.
template <class T>
inline void reduce(Quadric& q, const T* attribute, int width, double times = 1) {
  const double weight = static_cast<double>(attribute[4 * width]);
  if (!(weight > 0)) return;
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, xd = 0, yd = 0, zd = 0, dd = 0;
  for (int k = 0; k < width; ++k) {
    const T* g = attribute + 4 * k;
    const double x = g[0], y = g[1], z = g[2], d = g[3];
    xx += x * x, xy += x * y, xz += x * z, yy += y * y, yz += y * z, zz += z * z;
    xd += x * d, yd += y * d, zd += z * d;
    dd += d * d;
  }
  const double f = -times / weight;
  q.xx += f * xx, q.xy += f * xy, q.xz += f * xz, q.yy += f * yy, q.yz += f * yz, q.zz += f * zz;
  q.bx += f * xd, q.by += f * yd, q.bz += f * zd;
  q.c += f * dd;
}

/// Adds Σ_k −2 s_k (G_k·p + D_k) + W s_k²: the value of each component stays s_k wherever p is. With
/// `times` −1 it takes that back.
template <class T>
inline void hold(Quadric& q, const T* attribute, int width, const double* s, double times = 1) {
  const double weight = static_cast<double>(attribute[4 * width]);
  for (int k = 0; k < width; ++k) {
    const T* g = attribute + 4 * k;
    const double t = times * s[k];
    q.bx -= t * g[0], q.by -= t * g[1], q.bz -= t * g[2];
    q.c += t * (weight * s[k] - 2 * g[3]);
  }
}

/// The best value of component k at p.
template <class T>
inline double fitted_value(const T* attribute, int width, int k, Vec3d p) {
  const T* g = attribute + 4 * k;
  return (g[0] * p.x + g[1] * p.y + g[2] * p.z + g[3]) / attribute[4 * width];
}

/// Linear function over a triangle that takes given values at its corners: the gradient of one
/// component is value differences times these two vectors.
struct TriangleGradient {
  Vec3d u, v;  // dual basis of the edges p1 - p0 and p2 - p0 in the triangle's plane
  TriangleGradient(Vec3d e1, Vec3d e2, Vec3d unit_normal, double double_area) {
    u = cross(e2, unit_normal) / double_area;
    v = cross(unit_normal, e1) / double_area;
  }
  Vec3d operator()(double s0, double s1, double s2) const { return u * (s1 - s0) + v * (s2 - s0); }
};

}  // namespace fovea
