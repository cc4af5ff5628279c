#include "fovea/base/math.h"

namespace fovea {

Mat4 operator*(const Mat4& a, const Mat4& b) {
  Mat4 r;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += a(row, k) * b(k, column);
      r(row, column) = sum;
    }
  }
  return r;
}

Mat4 compose(Vec3d t, Quat q, Vec3d s) {
  const double x2 = q.x * 2, y2 = q.y * 2, z2 = q.z * 2;
  const double xx = q.x * x2, xy = q.x * y2, xz = q.x * z2;
  const double yy = q.y * y2, yz = q.y * z2, zz = q.z * z2;
  const double wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  Mat4 r;
  r.m = {(1 - yy - zz) * s.x,
         (xy + wz) * s.x,
         (xz - wy) * s.x,
         0,
         (xy - wz) * s.y,
         (1 - xx - zz) * s.y,
         (yz + wx) * s.y,
         0,
         (xz + wy) * s.z,
         (yz - wx) * s.z,
         (1 - xx - yy) * s.z,
         0,
         t.x,
         t.y,
         t.z,
         1};
  return r;
}

double in_single_precision(double x) { return static_cast<double>(static_cast<float>(x)); }

Vec3d in_single_precision(Vec3d p) {
  return {in_single_precision(p.x), in_single_precision(p.y), in_single_precision(p.z)};
}

Vec3d transform_point(const Mat4& a, Vec3d p) {
  return transform_direction(a, p) + Vec3d{a(0, 3), a(1, 3), a(2, 3)};
}

Vec3d transform_direction(const Mat4& a, Vec3d d) {
  return {a(0, 0) * d.x + a(0, 1) * d.y + a(0, 2) * d.z, a(1, 0) * d.x + a(1, 1) * d.y + a(1, 2) * d.z,
          a(2, 0) * d.x + a(2, 1) * d.y + a(2, 2) * d.z};
}

double determinant3(const Mat4& a) {
  const Vec3d c0{a(0, 0), a(1, 0), a(2, 0)};
  const Vec3d c1{a(0, 1), a(1, 1), a(2, 1)};
  const Vec3d c2{a(0, 2), a(1, 2), a(2, 2)};
  return dot(cross(c0, c1), c2);
}

Mat4 affine_inverse(const Mat4& a) {
  const Vec3d c0{a(0, 0), a(1, 0), a(2, 0)};
  const Vec3d c1{a(0, 1), a(1, 1), a(2, 1)};
  const Vec3d c2{a(0, 2), a(1, 2), a(2, 2)};
  const double det = determinant3(a);
  const Vec3d r0 = cross(c1, c2) / det, r1 = cross(c2, c0) / det, r2 = cross(c0, c1) / det;
  const Vec3d t{a(0, 3), a(1, 3), a(2, 3)};
  Mat4 r;
  r.m = {r0.x, r1.x, r2.x, 0, r0.y,        r1.y,        r2.y,        0,
         r0.z, r1.z, r2.z, 0, -dot(r0, t), -dot(r1, t), -dot(r2, t), 1};
  return r;
}

}  // namespace fovea
