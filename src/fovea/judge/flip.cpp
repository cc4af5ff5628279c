#include "fovea/judge/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fovea/base/error.h"
#include "fovea/base/math.h"
#include "fovea/base/srgb.h"

namespace fovea {

namespace {

constexpr double kPi = std::numbers::pi;
// Section 4 of the publication.
constexpr double kColorExponent = 0.7, kColorKnee = 0.4, kColorTarget = 0.95, kFeatureExponent = 0.5,
                 kFeatureWidthDeg = 0.082;

// --- Colour ---------------------------------------------------------------------------------------------

/// Linear sRGB to CIE XYZ, as rational numbers of the primaries and D65.
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

Vec3d multiply(const double (&m)[3][3], Vec3d v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

const Vec3d kWhite = multiply(kToXyz, {1, 1, 1});

Vec3d to_xyz(Vec3d rgb) { return multiply(kToXyz, rgb); }

/// The inverse of `kToXyz`, by Cramer's rule: its rows.
std::array<Vec3d, 3> inverse_rows() {
  const auto column = [](int k) { return Vec3d{kToXyz[0][k], kToXyz[1][k], kToXyz[2][k]}; };
  const Vec3d c0 = column(0), c1 = column(1), c2 = column(2);
  const double determinant = dot(c0, cross(c1, c2));
  return {cross(c1, c2) / determinant, cross(c2, c0) / determinant, cross(c0, c1) / determinant};
}
const std::array<Vec3d, 3> kFromXyz = inverse_rows();

Vec3d to_rgb(Vec3d xyz) { return {dot(kFromXyz[0], xyz), dot(kFromXyz[1], xyz), dot(kFromXyz[2], xyz)}; }

/// CIELAB of linear RGB, chroma scaled by lightness (Hunt effect).
Vec3d hunt_lab(Vec3d rgb) {
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Vec3d xyz = to_xyz(rgb);
  const double x = f(xyz.x / kWhite.x), y = f(xyz.y / kWhite.y), z = f(xyz.z / kWhite.z);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double hyab(Vec3d p, Vec3d q) { return std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z); }

/// The largest colour difference that counts: between green and blue.
double largest_difference() {
  return std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColorExponent);
}

// --- Filters --------------------------------------------------------------------------------------------

/// A term a √(π/b) exp(−π² x² / b) of a contrast sensitivity function, x in degrees.
struct SensitivityTerm {
  double a, b;
};
constexpr double kWidestB = 0.04;

/// Blurs by a sum of Gaussians that together have sum 1.
Plane blur(const Plane& plane, std::initializer_list<SensitivityTerm> terms, double pixels_per_degree) {
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kWidestB / (2 * kPi * kPi)) * pixels_per_degree));
  double total = 0;
  std::vector<double> weights;
  for (const auto& [a, b] : terms) {
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
      const double x = i / pixels_per_degree;
      sum += std::exp(-kPi * kPi * x * x / b);
    }
    weights.push_back(a * std::sqrt(kPi / b) * sum * sum);
    total += weights.back();
  }
  Plane result(plane.width, plane.height);
  std::size_t term = 0;
  for (const auto& [a, b] : terms) {
    const double sigma = std::sqrt(b / 2) / kPi * pixels_per_degree;
    // Beyond six σ there is less than a float's last bit.
    const std::vector<float> kernel =
        gaussian_kernel(sigma, std::min(radius, static_cast<int>(std::ceil(6 * sigma))));
    const Plane part = filter(plane, kernel, kernel, Border::replicate);
    const auto weight = static_cast<float>(weights[term++] / total);
    for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] += weight * part.values[i];
  }
  return result;
}

/// A derivative of a Gaussian, its positive weights with sum 1 and its negative ones with sum −1.
template <class F>
std::vector<float> derivative_kernel(double sigma, int radius, F&& f) {
  std::vector<double> weights;
  double positive = 0, negative = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double w = f(i) * std::exp(-i * i / (2 * sigma * sigma));
    weights.push_back(w);
    (w > 0 ? positive : negative) += std::abs(w);
  }
  std::vector<float> kernel;
  for (const double w : weights) kernel.push_back(static_cast<float>(w > 0 ? w / positive : w / negative));
  return kernel;
}

/// Length of the response to a kernel along x and along y, each smoothed across.
Plane strength(const Plane& plane, const std::vector<float>& kernel, const std::vector<float>& smooth) {
  Plane x = filter(plane, kernel, smooth, Border::replicate);
  const Plane y = filter(plane, smooth, kernel, Border::replicate);
  for (std::size_t i = 0; i < x.values.size(); ++i)
    x.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
  return x;
}

}  // namespace

FlipReference::FlipReference(const Image8& image, double pixels_per_degree)
    : width_(image.width),
      height_(image.height),
      pixels_per_degree_(pixels_per_degree),
      reference_(see(image)) {}

FlipReference::Seen FlipReference::see(const Image8& image) const {
  if (image.channels != 3) throw Error(ErrorKind::usage, "FLIP compares images of three channels");
  if (image.width != width_ || image.height != height_)
    throw Error(ErrorKind::usage, "images of different size cannot be compared");
  // Opponent colours: YCxCz, linear in XYZ.
  Plane y(width_, height_), cx(width_, height_), cz(width_, height_), achromatic(width_, height_);
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    const std::uint8_t* p = image.pixels.data() + 3 * i;
    const Vec3d xyz = to_xyz(Vec3d(Vec3f{to_light(p[0]), to_light(p[1]), to_light(p[2])}));
    const double x = xyz.x / kWhite.x, lum = xyz.y / kWhite.y, z = xyz.z / kWhite.z;
    y.values[i] = static_cast<float>(116 * lum - 16);
    cx.values[i] = static_cast<float>(500 * (x - lum));
    cz.values[i] = static_cast<float>(200 * (lum - z));
    achromatic.values[i] = static_cast<float>(lum);
  }
  Seen seen;
  const double sigma = 0.5 * kFeatureWidthDeg * pixels_per_degree_;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const std::vector<float> smooth = gaussian_kernel(sigma, radius);
  seen.edges = strength(achromatic, derivative_kernel(sigma, radius, [](double x) { return -x; }), smooth);
  seen.points = strength(
      achromatic, derivative_kernel(sigma, radius, [sigma](double x) { return x * x / (sigma * sigma) - 1; }),
      smooth);

  // Contrast sensitivity of the achromatic, red–green and blue–yellow channels.
  seen.lightness = blur(y, {{1, 0.0047}}, pixels_per_degree_);
  seen.a = blur(cx, {{1, 0.0053}}, pixels_per_degree_);
  seen.b = blur(cz, {{34.1, 0.04}, {13.5, 0.025}}, pixels_per_degree_);
  Vec3d opponent{-1e9, 0, 0}, lab;
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    const Vec3d here = seen.at(i);
    // Backgrounds are even: a pixel like the one before looks like it.
    if (!(here == opponent)) {
      opponent = here;
      const double lum = (here.x + 16) / 116, x = lum + here.y / 500, z = lum - here.z / 200;
      const Vec3d rgb = to_rgb({x * kWhite.x, lum * kWhite.y, z * kWhite.z});
      lab = hunt_lab(min(max(rgb, Vec3d{0, 0, 0}), Vec3d{1, 1, 1}));
    }
    seen.lightness.values[i] = static_cast<float>(lab.x);
    seen.a.values[i] = static_cast<float>(lab.y);
    seen.b.values[i] = static_cast<float>(lab.z);
  }
  return seen;
}

Plane FlipReference::map(const Image8& test) const {
  const double largest = largest_difference();
  const Seen seen = see(test);
  Plane result(width_, height_);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const Vec3d own = reference_.at(i), other = seen.at(i);
    if (own == other) continue;  // no difference of colour is none, whatever the features
    const double difference = std::pow(hyab(own, other), kColorExponent);
    const double knee = kColorKnee * largest;
    const double color = difference < knee
                             ? kColorTarget / knee * difference
                             : kColorTarget + (difference - knee) / (largest - knee) * (1 - kColorTarget);
    const double feature = std::max(std::abs(reference_.edges.values[i] - seen.edges.values[i]),
                                    std::abs(reference_.points.values[i] - seen.points.values[i]));
    const double feature_error = std::pow(std::sqrt(0.5) * feature, kFeatureExponent);
    result.values[i] = static_cast<float>(std::pow(std::min(color, 1.0), 1 - std::min(feature_error, 1.0)));
  }
  return result;
}

}  // namespace fovea
