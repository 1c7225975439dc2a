// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "list_tracer.h"

#include <fmt/format.h>

#include <map>

#include "support/scene_buffers.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

const char* const kernel_text = R"(
#include "trace/list.cl"
#include "shapes/surface.cl"

typedef struct {
  float p[3], error, ng[3];
  uint material;
} CrossingSurface;

__attribute__((vec_type_hint(float8))) __kernel void list_all(SCENE_PARAMETERS, __global const RayRecord* rays, uint capacity, __global HitRecord* closest,
                       __global int* any, __global uint* counts, __global HitRecord* sorted, __global CrossingSurface* found,
                       uint ray_count) {
  const uint i = (uint)get_global_id(0);
  if (i >= ray_count) return;
  SCENE_STRUCTS;
  const RayRecord ray = rays[i];
  closest[i] = trace_closest(&tree, ray);
  any[i] = trace_any(&tree, ray);
  const uint count = trace_all(&tree, ray, capacity, sorted + i * capacity);
  counts[i] = count;
  for (uint k = 0; k < min(count, capacity); k++) {
    const HitRecord hit = sorted[i * capacity + k];
    const Surface s = surface_at(&tree, &surfaces, &ray, &hit);
    __global CrossingSurface* out = found + i * capacity + k;
    vstore3(s.p, 0, out->p);
    vstore3(s.ng, 0, out->ng);
    out->error = s.error;
    out->material = s.material;
  }
}
)";

}  // namespace

bool is_leaving(const HitRecord& hit) { return (hit.surface & CAPLET_LEAVING) != 0; }
std::uint32_t surface_number(const HitRecord& hit) { return hit.surface & CAPLET_SURFACE_MASK; }

ListTracer::ListTracer(const Device& device, int width) : device_(device), width_(width) {}

std::vector<RayList> ListTracer::trace(const FlatScene& scene, std::span<const RayRecord> rays,
                                       std::uint32_t capacity) const {
  const std::size_t places = rays.size() * capacity;
  const SceneOnDevice buffers(device_, scene, width_);
  const Buffer<RayRecord> ray_buffer(device_, rays);
  const Buffer<HitRecord> closest(device_, rays.size()), sorted(device_, places);
  const Buffer<int> any(device_, rays.size());
  const Buffer<std::uint32_t> counts(device_, rays.size());
  const Buffer<CrossingSurface> surfaces(device_, places);
  auto found = kernels_.find(scene.leaf_kind_bits);
  if (found == kernels_.end()) {
    Program program = Program::from_source(
        device_, "list test", flatten_kernels(std::string(scene_parameters) + kernel_text),
        fmt::format("-DCAPLET_REAL_WIDTH={} -DCAPLET_LEAF_KIND_BITS={}", width_,
                    scene.leaf_kind_bits));
    found = kernels_.emplace(scene.leaf_kind_bits, program.kernel("list_all")).first;
  }
  cl::Kernel kernel = found->second;
  buffers.set_arguments(kernel, ray_buffer, static_cast<cl_uint>(capacity), closest, any, counts,
                        sorted, surfaces, static_cast<cl_uint>(rays.size()));
  launch(device_, kernel, rays.size(), 16);
  const auto closest_hits = closest.read(), sorted_hits = sorted.read();
  const auto anys = any.read();
  const auto count_values = counts.read();
  const auto surface_values = surfaces.read();
  std::vector<RayList> out(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t count = std::min(count_values[i], capacity);
    out[i] = {closest_hits[i], anys[i] != 0, count_values[i] > capacity, {}, {}};
    for (std::size_t k = i * capacity; k < i * capacity + count; ++k) {
      out[i].hits.push_back(sorted_hits[k]);
      out[i].surfaces.push_back(surface_values[k]);
    }
  }
  return out;
}

const ListTracer& list_tracer(int width) {
  static std::map<int, ListTracer> tracers;
  return tracers.try_emplace(width, test_device(), width).first->second;
}

}  // namespace caplet::test
