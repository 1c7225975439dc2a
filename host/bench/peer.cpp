// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "bench/peer.h"

#if CAPLET_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

#include "base/clock.h"

namespace caplet::bench {
namespace {

/// The program shares one device: scenes are cheap, devices are not.
RTCDevice device() {
  static const struct Owner {
    RTCDevice handle = rtcNewDevice(nullptr);
    ~Owner() { rtcReleaseDevice(handle); }
  } owner;
  return owner.handle;
}

RTCGeometryType type_of(int shape) {
  switch (shape) {
    case shape_triangle:
      return RTC_GEOMETRY_TYPE_TRIANGLE;
    case shape_sphere:
      return RTC_GEOMETRY_TYPE_SPHERE_POINT;
    case shape_disk:
      return RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT;
    case shape_capsule:
    case shape_tapered_capsule:
      return RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE;
    default:
      throw std::runtime_error("Embree has no such shape");
  }
}

}  // namespace

struct Peer::Scene {
  Scene() : handle(rtcNewScene(device())) {}
  ~Scene() { rtcReleaseScene(handle); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Returns the seconds that it took.
  double build(RTCGeometry geometry, PeerMode mode) {
    rtcSetSceneFlags(handle,
                     mode == PeerMode::robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const Clock::time_point start = Clock::now();
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(handle, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(handle);
    const double seconds = seconds_since(start);
    if (rtcGetDeviceError(device()) != RTC_ERROR_NONE)
      throw std::runtime_error("Embree could not build the scene");
    return seconds;
  }

  RTCScene handle;
};

Peer::Peer(std::span<const FlatPrimitive> primitives, PeerMode mode)
    : scene_(std::make_unique<Scene>()) {
  const auto shape = static_cast<int>(primitives[0].shape);
  const std::size_t count = primitives.size();
  const RTCGeometry geometry = rtcNewGeometry(device(), type_of(shape));
  const auto floats = [&](RTCBufferType type, RTCFormat format, std::size_t components,
                          std::size_t items) {
    return static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, type, 0, format, components * sizeof(float), items));
  };
  if (shape == shape_triangle) {
    float* vertices = floats(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3, 3 * count);
    unsigned* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count));
    for (std::size_t i = 0; i < count; i++)
      std::copy(primitives[i].data, primitives[i].data + 9, vertices + 9 * i);
    for (std::size_t i = 0; i < 3 * count; i++) indices[i] = static_cast<unsigned>(i);
  } else if (shape == shape_sphere) {
    float* vertices = floats(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4, count);
    for (std::size_t i = 0; i < count; i++)
      std::copy(primitives[i].data, primitives[i].data + 4, vertices + 4 * i);
  } else if (shape == shape_disk) {
    float* vertices = floats(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4, count);
    float* normals = floats(RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3, count);
    for (std::size_t i = 0; i < count; i++) {
      const float* d = primitives[i].data;
      std::copy(d, d + 3, vertices + 4 * i);
      vertices[4 * i + 3] = d[6];
      std::copy(d + 3, d + 6, normals + 3 * i);
    }
  } else {
    float* vertices = floats(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4, 2 * count);
    unsigned* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(unsigned), count));
    for (std::size_t i = 0; i < count; i++) {
      const float* d = primitives[i].data;
      const float ends[8] = {d[0], d[1], d[2], d[6],
                             d[3], d[4], d[5], shape == shape_capsule ? d[6] : d[7]};
      std::copy(ends, ends + 8, vertices + 8 * i);
      indices[i] = static_cast<unsigned>(2 * i);
    }
  }
  build_seconds_ = scene_->build(geometry, mode);
}

Peer::Peer(const RoundCurves& curves, PeerMode mode) : scene_(std::make_unique<Scene>()) {
  const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  float* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                              4 * sizeof(float), curves.vertices.size()));
  for (const auto& vertex : curves.vertices)
    vertices = std::copy(vertex.begin(), vertex.end(), vertices);
  unsigned* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(unsigned), curves.first.size()));
  std::copy(curves.first.begin(), curves.first.end(), indices);
  build_seconds_ = scene_->build(geometry, mode);
}

Peer::~Peer() = default;

bool Peer::is_there() { return true; }

std::string Peer::version() {
  const auto property = [](RTCDeviceProperty name) {
    return std::to_string(rtcGetDeviceProperty(device(), name));
  };
  return property(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." +
         property(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
         property(RTC_DEVICE_PROPERTY_VERSION_PATCH) + ", back faces culled: of triangles " +
         property(RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED) + ", of curves " +
         property(RTC_DEVICE_PROPERTY_BACKFACE_CULLING_CURVES_ENABLED);
}

namespace {

RTCRay ray_of(const RayRecord& r) {
  RTCRay ray{};
  ray.org_x = r.ox;
  ray.org_y = r.oy;
  ray.org_z = r.oz;
  ray.tnear = r.t_min;
  ray.dir_x = r.dx;
  ray.dir_y = r.dy;
  ray.dir_z = r.dz;
  ray.tfar = r.t_max;
  ray.mask = ~0u;
  return ray;
}

/// Calls `ask(i, arguments...)` for every ray: Embree 3 takes a context between the scene and the
/// ray.
template <class Ask>
void for_each_ray(std::size_t count, const Ask& ask) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
#if CAPLET_EMBREE_MAJOR == 3
                      RTCIntersectContext context;
                      rtcInitIntersectContext(&context);
                      for (std::size_t i = range.begin(); i < range.end(); i++) ask(i, &context);
#else
    for (std::size_t i = range.begin(); i < range.end(); i++) ask(i);
#endif
                    });
}

template <class Store>
void trace_with(RTCScene scene, std::span<const RayRecord> rays, const Store& store) {
  for_each_ray(rays.size(), [&](std::size_t i, auto... context) {
    RTCRayHit hit{};
    hit.ray = ray_of(rays[i]);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, context..., &hit);
    store(i, hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? PeerHit{}
                                                       : PeerHit{hit.hit.primID, hit.ray.tfar});
  });
}

}  // namespace

std::vector<PeerHit> Peer::closest(std::span<const RayRecord> rays) const {
  std::vector<PeerHit> out(rays.size());
  trace_with(scene_->handle, rays, [&](std::size_t i, const PeerHit& hit) { out[i] = hit; });
  return out;
}

std::size_t Peer::trace(std::span<const RayRecord> rays, std::span<std::uint32_t> ids) const {
  trace_with(scene_->handle, rays, [&](std::size_t i, const PeerHit& hit) { ids[i] = hit.id; });
  return static_cast<std::size_t>(
      std::count_if(ids.begin(), ids.end(), [](std::uint32_t id) { return id != CAPLET_NONE; }));
}

std::size_t Peer::trace_any(std::span<const RayRecord> rays, std::span<std::uint32_t> found) const {
  for_each_ray(rays.size(), [&](std::size_t i, auto... context) {
    RTCRay ray = ray_of(rays[i]);
    rtcOccluded1(scene_->handle, context..., &ray);
    found[i] = ray.tfar < 0 ? 1 : 0;
  });
  return static_cast<std::size_t>(std::count(found.begin(), found.end(), 1u));
}

}  // namespace caplet::bench
