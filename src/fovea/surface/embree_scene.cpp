#include "fovea/surface/embree_scene.h"

#include <cstring>

#include "fovea/base/error.h"

namespace fovea {

RTCGeometry EmbreeScene::make_geometry(const Surface& surface) {
  // One thread: many small trees are built, and results must not depend on the build's order.
  device_ = rtcNewDevice("threads=1");
  if (device_ == nullptr) throw Error(ErrorKind::internal, "Embree gives no device");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(Vec3f), surface.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(std::uint32_t), surface.triangles.size());
  std::memcpy(positions, surface.positions.data(), surface.positions.size() * sizeof(Vec3f));
  std::memcpy(indices, surface.triangles.data(), surface.triangles.size() * 3 * sizeof(std::uint32_t));
  return geometry;
}

void EmbreeScene::commit(RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

}  // namespace fovea
