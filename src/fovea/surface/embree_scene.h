#pragma once

#include <embree3/rtcore.h>

#include <memory>

#include "fovea/surface/surface.h"

namespace fovea {

/// The triangles of a surface in Embree's tree, numbered as in the surface. Internal: its header is Embree's.
///
/// Embree ends the program for coordinates beyond 10¹⁸ and loses those near 0, so what is unusually large or
/// small is in the tree at another scale.
class EmbreeScene {
 public:
  /// O(#F log #F); nothing without triangles. `set_up` may change the geometry before it is committed. Throws
  /// Error(unsupported) for positions that are not finite: too large for single precision; std::bad_alloc.
  template <class SetUp>
  EmbreeScene(const Surface& surface, SetUp&& set_up) {
    if (surface.triangles.empty()) return;
    const RTCGeometry geometry = make_geometry(surface);
    set_up(geometry);
    commit(geometry);
  }
  explicit EmbreeScene(const Surface& surface) : EmbreeScene(surface, [](RTCGeometry) {}) {}
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  bool empty() const { return scene_ == nullptr; }
  RTCScene get() const { return scene_.get(); }
  /// Lengths in the tree, of the surface's: a power of two, mostly 1.
  double scale() const { return scale_; }
  /// A point, or the way to one, in the tree; what is far outside is only roughly where it was.
  Vec3f to_tree(Vec3d p) const;
  float to_tree(double length) const { return to_tree(Vec3d{length, 0, 0}).x; }

 private:
  RTCGeometry make_geometry(const Surface& surface);
  void commit(RTCGeometry geometry);

  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
  double scale_ = 1;
};

}  // namespace fovea
