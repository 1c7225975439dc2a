// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "bench/device_tracer.h"

#include <fmt/format.h>

#include <cstdlib>

namespace caplet::bench {
namespace {

const char* const kernels = R"(
#include "groups.cl"
typedef struct {
  __global const RayRecord* restrict rays;
  __global HitRecord* restrict hits;
  __global int* restrict any;
} Stage;
static RayRecord traced_ray(const Stage* g, uint item) { return g->rays[item]; }
#if TRACED_ANY
static void traced_hit(const Stage* g, uint item, const HitRecord* hit) { g->any[item] = hit->slot != CAPLET_NONE; }
#else
static void traced_hit(const Stage* g, uint item, const HitRecord* hit) { g->hits[item] = *hit; }
#endif
#if CAPLET_POOL
#include "trace/stream.cl"
#else
#include "trace/trace.cl"
#endif
__kernel void trace(__global const float* restrict nodes, __global const float* restrict leaves,
    __global const InstanceRecord* restrict instances, uint root, __global const RayRecord* restrict rays, uint count,
    __global HitRecord* restrict hits, __global int* restrict any) {
  const Stage stage = {rays, hits, any};
  const Tree tree = {0, nodes, leaves, instances};
#if CAPLET_POOL
  const uint share = (count + (uint)get_global_size(0) - 1) / (uint)get_global_size(0), first = (uint)get_global_id(0) * share;
#if CAPLET_POOL == 2
  for (uint i = first; i < min(count, first + share); i += CAPLET_STREAM_RAYS)
    trace_stream(&stage, &tree, root, i, min((uint)CAPLET_STREAM_RAYS, min(count, first + share) - i));
#else
  if (first < count) trace_pool(&stage, &tree, root, first, min(count, first + share));
#endif
#else
  const uint i = (uint)get_global_id(0);
  if (i < count) {
    const HitRecord hit = trace_ray(&tree, root, rays[i], TRACED_ANY);
    traced_hit(&stage, i, &hit);
  }
#endif
}
)";

}  // namespace

DeviceTracer::DeviceTracer(const Device& device, int width, const std::string& options)
    : device_(device),
      pool_(width == 8 && std::getenv("POOL") != nullptr),
      closest_(Program::from_source(device, "trace_closest", flatten_kernels(kernels), fmt::format("-DCAPLET_REAL_WIDTH={} -DCAPLET_POOL={} -DTRACED_ANY=0 {}", width, (pool_ ? std::getenv("POOL") : "0"), options)).kernel("trace")),
      any_(Program::from_source(device, "trace_any", flatten_kernels(kernels), fmt::format("-DCAPLET_REAL_WIDTH={} -DCAPLET_POOL={} -DTRACED_ANY=1 {}", width, (pool_ ? std::getenv("POOL") : "0"), options)).kernel("trace")) {}

void DeviceTracer::upload(std::span<const float> nodes, std::span<const float> leaves, std::span<const InstanceRecord> instances,
                          uint root) {
  nodes_ = Buffer<float>(device_, nodes);
  leaves_ = Buffer<float>(device_, leaves);
  instances_ = Buffer<InstanceRecord>(device_, instances);
  root_ = root;
}

void DeviceTracer::set_rays(std::span<const RayRecord> rays) {
  rays_ = Buffer<RayRecord>(device_, rays);
  hits_ = Buffer<HitRecord>(device_, rays.size());
  anys_ = Buffer<int>(device_, rays.size());
}

void DeviceTracer::run(cl::Kernel& kernel) {
  const std::size_t count = rays_.size();
  kernel.setArg(0, nodes_.handle());
  kernel.setArg(1, leaves_.handle());
  kernel.setArg(2, instances_.handle());
  kernel.setArg(3, root_);
  kernel.setArg(4, rays_.handle());
  kernel.setArg(5, static_cast<cl_uint>(count));
  kernel.setArg(6, hits_.handle());
  kernel.setArg(7, anys_.handle());
  if (pool_)
    launch(device_, kernel, (count + 1023) / 1024, 1);
  else
    launch(device_, kernel, count, 64);
  device_.finish();
}

void DeviceTracer::run_closest() { run(closest_); }
void DeviceTracer::run_any() { run(any_); }
std::vector<HitRecord> DeviceTracer::hits() const { return hits_.read(); }
std::vector<int> DeviceTracer::any() const { return anys_.read(); }

std::vector<HitRecord> DeviceTracer::closest(std::span<const RayRecord> rays) {
  set_rays(rays);
  run_closest();
  return hits();
}

std::vector<int> DeviceTracer::any(std::span<const RayRecord> rays) {
  set_rays(rays);
  run_any();
  return any();
}

}  // namespace caplet::bench
