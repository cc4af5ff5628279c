#pragma once

#include <embree3/rtcore.h>

#include "fovea/surface/surface.h"

namespace fovea {

/// The triangles of a surface in Embree's tree, numbered as in the surface. Internal: its header is Embree's.
class EmbreeScene {
 public:
  /// O(#F log #F); nothing without triangles. `set_up` may change the geometry before it is committed.
  template <class SetUp>
  EmbreeScene(const Surface& surface, SetUp&& set_up) {
    if (surface.triangles.empty()) return;
    const RTCGeometry geometry = make_geometry(surface);
    set_up(geometry);
    commit(geometry);
  }
  explicit EmbreeScene(const Surface& surface) : EmbreeScene(surface, [](RTCGeometry) {}) {}
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  bool empty() const { return scene_ == nullptr; }
  RTCScene get() const { return scene_; }

 private:
  RTCGeometry make_geometry(const Surface& surface);
  void commit(RTCGeometry geometry);

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace fovea
