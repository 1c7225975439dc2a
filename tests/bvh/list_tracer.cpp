// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "list_tracer.h"

#include <fmt/format.h>

#include <limits>

namespace caplet::test {
namespace {

const char* const kernel_text = R"(
#include "trace/list.cl"
#include "shapes/surface.cl"

typedef struct {
  float p[3], error, ng[3];
  uint material;
} CrossingSurface;

__kernel void list_all(__global const float* nodes, __global const float* leaves, __global const InstanceRecord* instances,
                       __global const GeometryRecord* geometries, __global const uint* primitive_geometry,
                       __global const uint* surface_materials, __global const uint* mesh_indices,
                       __global const float* mesh_normals, __global const float* mesh_uvs, uint root,
                       __global const RayRecord* rays, uint capacity, __global HitRecord* closest, __global int* any,
                       __global uint* counts, __global HitRecord* sorted, __global CrossingSurface* surfaces, uint ray_count) {
  const uint i = (uint)get_global_id(0);
  if (i >= ray_count) return;
  Globals g;
  g.nodes = nodes;
  g.leaves = leaves;
  g.instances = instances;
  g.geometries = geometries;
  g.primitive_geometry = primitive_geometry;
  g.surface_materials = surface_materials;
  g.mesh_indices = mesh_indices;
  g.mesh_normals = mesh_normals;
  g.mesh_uvs = mesh_uvs;
  const RayRecord ray = rays[i];
  closest[i] = trace_closest(nodes, leaves, instances, root, ray);
  any[i] = trace_any(nodes, leaves, instances, root, ray);
  const uint count = trace_all(nodes, leaves, instances, root, ray, capacity, sorted + i * capacity);
  counts[i] = count;
  for (uint k = 0; k < min(count, capacity); k++) {
    const HitRecord hit = sorted[i * capacity + k];
    const Surface s = surface_at(&g, &ray, &hit);
    __global CrossingSurface* out = surfaces + i * capacity + k;
    vstore3(s.p, 0, out->p);
    vstore3(s.ng, 0, out->ng);
    out->error = s.error;
    out->material = s.material;
  }
}
)";

template <class T>
Buffer<T> upload(const Device& device, const std::vector<T>& values) {
  return Buffer<T>(device, std::span<const T>(values));
}

}  // namespace

bool is_leaving(const HitRecord& hit) { return (hit.surface & CAPLET_LEAVING) != 0; }
std::uint32_t surface_number(const HitRecord& hit) { return hit.surface & CAPLET_SURFACE_MASK; }

ListTracer::ListTracer(const Device& device, int width)
    : device_(device),
      kernel_(
          Program::from_source(device, "list test", flatten_kernels(kernel_text), fmt::format("-DCAPLET_REAL_WIDTH={}", width))
              .kernel("list_all")) {}

std::vector<RayList> ListTracer::trace(const FlatScene& scene, std::span<const RayRecord> rays, std::uint32_t capacity) const {
  const std::size_t places = rays.size() * capacity;
  const auto nodes = upload(device_, scene.nodes), leaves = upload(device_, scene.leaves);
  const auto instances = upload(device_, scene.instances);
  const auto geometries = upload(device_, scene.geometries);
  const auto primitives = upload(device_, scene.primitive_geometry), materials = upload(device_, scene.surface_materials),
             indices = upload(device_, scene.mesh_indices);
  const auto normals = upload(device_, scene.mesh_normals), uvs = upload(device_, scene.mesh_uvs);
  const Buffer<RayRecord> ray_buffer(device_, rays);
  const Buffer<HitRecord> closest(device_, rays.size()), sorted(device_, places);
  const Buffer<int> any(device_, rays.size());
  const Buffer<std::uint32_t> counts(device_, rays.size());
  const Buffer<CrossingSurface> surfaces(device_, places);
  cl::Kernel kernel = kernel_;
  set_arguments(device_, kernel, nodes, leaves, instances, geometries, primitives, materials, indices, normals, uvs,
                static_cast<cl_uint>(scene.params.root), ray_buffer, static_cast<cl_uint>(capacity), closest, any, counts, sorted,
                surfaces, static_cast<cl_uint>(rays.size()));
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

RayRecord list_ray(const glm::dvec3& o, const glm::dvec3& d) {
  return {static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z), 0,
          static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z), std::numeric_limits<float>::infinity()};
}

}  // namespace caplet::test
