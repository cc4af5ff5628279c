#include "fovea/surface/rigid_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace fovea {

namespace {

using Matrix4 = std::array<std::array<double, 4>, 4>;

Vec3d mean(std::span<const Vec3d> points) {
  Vec3d sum;
  for (const Vec3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Makes A(p, q) zero by a rotation (Jacobi).
void rotate_away(Matrix4& A, std::size_t p, std::size_t q) {
  if (A[p][q] == 0) return;
  const double slope = (A[q][q] - A[p][p]) / (2 * A[p][q]);
  const double tangent = std::copysign(1 / (std::abs(slope) + std::hypot(slope, 1)), slope);
  const double cosine = 1 / std::hypot(tangent, 1), sine = tangent * cosine;
  const auto turn = [&](double& x, double& y) {
    const double turned = cosine * x - sine * y;
    y = sine * x + cosine * y;
    x = turned;
  };
  for (auto& row : A) turn(row[p], row[q]);
  for (std::size_t k = 0; k < 4; ++k) turn(A[p][k], A[q][k]);
}

double largest_eigenvalue(Matrix4 A) {
  constexpr int kSweeps = 10;  // each about squares what is left beside the diagonal; five are enough
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t p = 0; p < 4; ++p) {
      for (std::size_t q = p + 1; q < 4; ++q) rotate_away(A, p, q);
    }
  }
  return std::max({A[0][0], A[1][1], A[2][2], A[3][3]});
}

/// The largest trace of R · S over all rotations R, S = Σ a bᵀ given by its columns.
double largest_trace(Vec3d x, Vec3d y, Vec3d z) {
  return largest_eigenvalue({{{x.x + y.y + z.z, z.y - y.z, x.z - z.x, y.x - x.y},
                              {z.y - y.z, x.x - y.y - z.z, y.x + x.y, x.z + z.x},
                              {x.z - z.x, y.x + x.y, -x.x + y.y - z.z, z.y + y.z},
                              {y.x - x.y, x.z + z.x, z.y + y.z, -x.x - y.y + z.z}}});
}

}  // namespace

double rigid_distance(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  if (a.empty()) return 0;
  const Vec3d mean_a = mean(a), mean_b = mean(b);
  double squares = 0;
  Vec3d x, y, z;  // columns of Σ a bᵀ
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3d p = a[i] - mean_a, q = b[i] - mean_b;
    squares += length_squared(p) + length_squared(q);
    x += p * q.x;
    y += p * q.y;
    z += p * q.z;
  }
  // Σ ‖p − R q‖² = Σ ‖p‖² + ‖q‖² − 2 p·R q
  const double left = squares - 2 * largest_trace(x, y, z);
  return std::sqrt(std::max(left, 0.0) / static_cast<double>(a.size()));
}

}  // namespace fovea
