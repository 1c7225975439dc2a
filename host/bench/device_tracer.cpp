// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "bench/device_tracer.h"

#include <fmt/format.h>

namespace caplet::bench {
namespace {

const char* const kernels = R"(
#include "trace/trace.cl"
#define ARGUMENTS __global const float* restrict nodes, __global const float* restrict leaves, \
    __global const InstanceRecord* restrict instances, uint root, __global const RayRecord* restrict rays, uint count
__kernel void closest(ARGUMENTS, __global HitRecord* restrict out) {
  const uint i = (uint)get_global_id(0);
  const Tree tree = {0, nodes, leaves, instances};
  if (i < count) out[i] = trace_ray(&tree, root, rays[i], 0);
}
__kernel void any_hit(ARGUMENTS, __global int* restrict out) {
  const uint i = (uint)get_global_id(0);
  const Tree tree = {0, nodes, leaves, instances};
  if (i < count) out[i] = trace_ray(&tree, root, rays[i], 1).slot != CAPLET_NONE;
}
)";

}  // namespace

DeviceTracer::DeviceTracer(const Device& device, int width, const std::string& options, const RowMasks& rows)
    : device_(device),
      program_(Program::from_source(device, "trace_test", flatten_kernels(kernels, rows),
                                    fmt::format("-DCAPLET_REAL_WIDTH={} {}", width, options))),
      closest_(program_.kernel("closest")),
      any_(program_.kernel("any_hit")) {}

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

void DeviceTracer::run(cl::Kernel& kernel, const cl::Buffer& out) {
  const std::size_t count = rays_.size();
  kernel.setArg(0, nodes_.handle());
  kernel.setArg(1, leaves_.handle());
  kernel.setArg(2, instances_.handle());
  kernel.setArg(3, root_);
  kernel.setArg(4, rays_.handle());
  kernel.setArg(5, static_cast<cl_uint>(count));
  kernel.setArg(6, out);
  launch(device_, kernel, count, 64);
  device_.finish();
}

void DeviceTracer::run_closest() { run(closest_, hits_.handle()); }
void DeviceTracer::run_any() { run(any_, anys_.handle()); }
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
