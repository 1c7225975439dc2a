// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "bench/device_tracer.h"

#include <fmt/format.h>

#include "lower/packed_nodes.h"

namespace caplet::bench {
namespace {

// These stages are like a renderer's, with a struct for their arguments. They disable putting
// several work-items into one vector (kernels/stages/kernel.cl): Intel's compiler of 2025 crashes
// on this kernel otherwise.
const char* const kernels = R"(
#include "groups.cl"
typedef struct {
  Tree tree;
  uint root;
  __global const RayRecord* restrict rays;
  __global HitRecord* restrict hits;
  __global int* restrict any;
} Stage;
static __global const RayRecord* traced_ray_at(const Stage* g, uint item) { return g->rays + item; }
static void traced_hit(const Stage* g, uint item, const HitRecord* hit) {
  if (TRACED_ANY) g->any[item] = hit->slot != CAPLET_NONE;
  else g->hits[item] = *hit;
}
#define TRACED_TREE(g) (&(g)->tree)
#define TRACED_ROOT(g, item) ((g)->root)
#if TRACED_ANY
#define TRACED_ENOUGH(g, item) INFINITY
#endif
#include "trace/many.cl"
__attribute__((vec_type_hint(float8))) __kernel void trace(__global const float* restrict nodes, __global const float* restrict leaves,
    __global const InstanceRecord* restrict instances, uint root, __global const RayRecord* restrict rays,
    __global HitRecord* restrict hits, __global int* restrict any, uint item_count) {
  const Stage stage = {{0, nodes, leaves, instances}, root, rays, hits, any};
#include "stages/items.cl"
}
)";

}  // namespace

DeviceTracer::DeviceTracer(const Device& device, int width, const std::string& options,
                           const RowMasks& rows, Manner manner)
    : device_(device), shares_(width == 8) {
  const std::string all = fmt::format("-DCAPLET_REAL_WIDTH={} {} {}", width,
                                      manner == Manner::stream       ? "-DTRACED_NEIGHBOURS=1"
                                      : manner == Manner::one_by_one ? "-DCAPLET_ONE_BY_ONE"
                                                                     : "",
                                      options);
  const std::string source = flatten_kernels(kernels, rows);
  closest_ = Program::from_source(device, "trace_closest", source, all + " -DTRACED_ANY=0")
                 .kernel("trace");
  any_ = Program::from_source(device, "trace_any", source, all + " -DTRACED_ANY=1").kernel("trace");
}

void DeviceTracer::upload(std::span<const float> nodes, std::span<const float> leaves,
                          std::span<const InstanceRecord> instances, uint root) {
  nodes_ = shares_ ? Buffer<float>(device_, nodes)
                   : Buffer<float>(device_, std::span<const float>(packed_nodes(nodes)));
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
  kernel.setArg(5, hits_.handle());
  kernel.setArg(6, anys_.handle());
  kernel.setArg(7, static_cast<cl_uint>(count));
  if (shares_)
    launch_shares(device_, kernel, count);
  else
    launch_items(device_, kernel, count, 64);
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
