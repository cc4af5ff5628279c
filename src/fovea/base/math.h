#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fovea {

/// A pair of numbers; texture coordinates, mostly.
template <class T>
struct Vec2 {
  T x{}, y{};
  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator*(Vec2 a, T s) { return {a.x * s, a.y * s}; }
  friend constexpr bool operator==(Vec2, Vec2) = default;
};

/// A triple of numbers; points and directions.
template <class T>
struct Vec3 {
  T x{}, y{}, z{};
  constexpr Vec3() = default;
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  template <class U>
  explicit constexpr Vec3(const Vec3<U>& v)
      : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  friend constexpr bool operator==(Vec3, Vec3) = default;
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

/// What is left of a number in single precision, also in programs that are built without
/// -fno-tree-slp-vectorize, where GCC 12 may drop `Vec3d(Vec3f(p))`.
double in_single_precision(double x);
Vec3d in_single_precision(Vec3d p);

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length_squared(Vec3<T> a) {
  return dot(a, a);
}
template <class T>
T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
/// Unit vector along `a`, or `a` itself when its length is zero.
template <class T>
Vec3<T> normalized(Vec3<T> a) {
  const T l = length(a);
  return l > T(0) ? a / l : a;
}
template <class T>
T triangle_area(Vec3<T> a, Vec3<T> b, Vec3<T> c) {
  return length(cross(b - a, c - a)) / 2;
}
/// z of the cross product: twice the signed area of the triangle (0, a, b).
template <class T>
constexpr T cross(Vec2<T> a, Vec2<T> b) {
  return a.x * b.y - a.y * b.x;
}
template <class T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// A rotation as glTF stores it: (x, y, z, w), w the real part.
struct Quat {
  double x = 0, y = 0, z = 0, w = 1;
  friend constexpr bool operator==(Quat, Quat) = default;
};

/// A 4×4 matrix, column-major like glTF: element (row, column) is m[4 * column + row].
struct Mat4 {
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  double operator()(int row, int column) const { return m[4 * column + row]; }
  double& operator()(int row, int column) { return m[4 * column + row]; }
  friend bool operator==(const Mat4&, const Mat4&) = default;
};

Mat4 operator*(const Mat4& a, const Mat4& b);
/// Translation · rotation · scale.
Mat4 compose(Vec3d translation, Quat rotation, Vec3d scale);
/// `a` applied to the point `p` (w = 1, no perspective division).
Vec3d transform_point(const Mat4& a, Vec3d p);
/// `a` applied to the direction `d` (w = 0).
Vec3d transform_direction(const Mat4& a, Vec3d d);
/// Determinant of the upper left 3×3; negative when the matrix mirrors.
double determinant3(const Mat4& a);
/// Inverse of an affine matrix; the matrix must not be singular.
Mat4 affine_inverse(const Mat4& a);

/// An axis-aligned box; empty until something is added.
struct Box {
  Vec3d low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Vec3d high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
             -std::numeric_limits<double>::infinity()};

  bool empty() const { return low.x > high.x; }
  void add(Vec3d p) {
    low = min(low, p);
    high = max(high, p);
  }
  void add(const Box& b) {
    low = min(low, b.low);
    high = max(high, b.high);
  }
  Vec3d center() const { return empty() ? Vec3d{} : (low + high) * 0.5; }
  /// Length of the diagonal; 0 when empty.
  double diagonal() const { return empty() ? 0.0 : length(high - low); }
};

/// A ball around something.
struct Sphere {
  Vec3d center;
  double radius = 0;
};

}  // namespace fovea
