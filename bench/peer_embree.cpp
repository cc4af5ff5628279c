#include <embree3/rtcore.h>

#include <array>
#include <limits>
#include <memory>

#include "fovea/base/parallel.h"
#include "render_peers.h"

namespace fovea::bench {
namespace {

constexpr int kPacket = 8;  // rays

struct EmbreeScene {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);

  EmbreeScene() = default;
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void add(const SceneMesh& mesh) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::vector<Vec3f>& positions = mesh.surface.positions;
    const auto& triangles = mesh.mesh->triangles;
    auto* const vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), positions.size()));
    std::copy(positions.begin(), positions.end(), vertices);
    using Indices = std::array<std::uint32_t, 3>;
    auto* const indices = static_cast<Indices*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Indices), triangles.size()));
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) indices[f][k] = triangles[f][k].value;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
};

/// Rays through a row of samples; their number along the row is a multiple of a packet's.
std::uint64_t trace_row(RTCScene scene, const View& view, int samples, int row) {
  const double step = 2 * view.half_height / samples;
  const double up = view.half_height - (row + 0.5) * step;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::uint64_t hits = 0;
  alignas(32) std::array<int, kPacket> valid;
  valid.fill(-1);
  for (int first = 0; first < samples; first += kPacket) {
    RTCRayHit8 rays{};
    for (int i = 0; i < kPacket; ++i) {
      const double right = (first + i + 0.5) * step - view.half_height;
      const Vec3f direction(view.right * right + view.up * up - view.back), eye(view.eye);
      rays.ray.org_x[i] = eye.x, rays.ray.org_y[i] = eye.y, rays.ray.org_z[i] = eye.z;
      rays.ray.dir_x[i] = direction.x, rays.ray.dir_y[i] = direction.y, rays.ray.dir_z[i] = direction.z;
      rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
      rays.ray.mask[i] = ~0u;
      rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid.data(), scene, &context, &rays);
    for (const unsigned id : rays.hit.geomID) hits += id != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

}  // namespace

std::function<std::uint64_t()> embree_peer(const ViewJob& job) {
  auto embree = std::make_shared<EmbreeScene>();
  for (const SceneMesh& mesh : job.scene->meshes) embree->add(mesh);
  rtcCommitScene(embree->scene);
  return [job, embree] {
    Context context;
    context.threads = job.threads;
    const int samples = 2 * job.size;
    const auto rows = static_cast<std::size_t>(samples);
    std::vector<std::uint64_t> hits(rows * job.views.size());
    parallel_for(context, hits.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        hits[i] = trace_row(embree->scene, job.views[i / rows], samples, static_cast<int>(i % rows));
    });
    std::uint64_t sum = 0;
    for (const std::uint64_t n : hits) sum += n;
    return sum;
  };
}

}  // namespace fovea::bench
