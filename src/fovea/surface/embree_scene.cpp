#include "fovea/surface/embree_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

#include "fovea/base/error.h"

namespace fovea {

namespace {

/// Throws what Embree says went wrong with a device, or with making one: for lack of memory it builds no
/// tree, or an empty one.
void check_device(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error != RTC_ERROR_NONE || device == nullptr)
    throw Error(ErrorKind::internal, fmt::format("Embree fails with error {}", static_cast<int>(error)));
}

/// The power of two that brings the largest coordinate near 1, if it is unusual.
double scale_for(const Surface& surface) {
  constexpr float kUsualLow = 1e-9f, kUsualHigh = 1e12f;
  float largest = 0;
  for (const Vec3f& p : surface.positions) {
    for (const float x : {p.x, p.y, p.z}) {
      if (!std::isfinite(x))
        throw Error(ErrorKind::unsupported, "positions are too large for single precision", {},
                    "scale the model or the nodes that show it down");
      largest = std::max(largest, std::abs(x));
    }
  }
  if (largest == 0 || (largest >= kUsualLow && largest <= kUsualHigh)) return 1;
  return std::exp2(-std::ilogb(largest));
}

}  // namespace

RTCGeometry EmbreeScene::make_geometry(const Surface& surface) {
  scale_ = scale_for(surface);
  // One thread: many small trees are built, and results must not depend on the build's order.
  device_.reset(rtcNewDevice("threads=1"));
  check_device(device_.get());
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(Vec3f), surface.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(std::uint32_t), surface.triangles.size());
  std::transform(surface.positions.begin(), surface.positions.end(), static_cast<Vec3f*>(positions),
                 [&](Vec3f p) { return scale_ == 1 ? p : to_tree(Vec3d(p)); });
  std::memcpy(indices, surface.triangles.data(), surface.triangles.size() * 3 * sizeof(std::uint32_t));
  return geometry;
}

Vec3f EmbreeScene::to_tree(Vec3d p) const {
  constexpr double kFar = 1e16;  // what is there hides and reaches nothing
  const Vec3d q = p * scale_;
  const double farthest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  return Vec3f(farthest <= kFar ? q : q / (farthest / kFar));
}

void EmbreeScene::commit(RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_.get());
  check_device(device_.get());
}

}  // namespace fovea
