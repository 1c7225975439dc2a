// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene_probe.h"

#include <fmt/format.h>

#include <map>
#include <tuple>

#include "device/detail/flatten.h"
#include "support/scene_buffers.h"
#include "support/test_device.h"

namespace caplet::test {

namespace {

const char* const kernel_text = R"(
#include "trace/trace.cl"
#include "shapes/surface.cl"

typedef struct {
  float t, u, v, error, p[3];
  uint found;
  float ng[3];
  uint surface;
  float ns[3];
  uint leaving;
  float dpdu[3];
  uint any;
  float dpdv[3];
  uint instance;
} SceneHit;

__attribute__((vec_type_hint(float8))) __kernel void scene_trace(SCENE_PARAMETERS, __global const RayRecord* rays, __global SceneHit* hits, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  SCENE_STRUCTS;
  const RayRecord ray = rays[i];
  const HitRecord hit = trace_closest(&tree, ray);
  __global SceneHit* out = hits + i;
  out->any = (uint)trace_any(&tree, ray);
  out->found = hit.slot != CAPLET_NONE;
  if (hit.slot == CAPLET_NONE) return;
  const Surface s = surface_at(&tree, &surfaces, &ray, &hit);
  out->t = hit.t;
  out->u = s.uv.x;
  out->v = s.uv.y;
  out->error = s.error;
  vstore3(s.p, 0, out->p);
  vstore3(s.ng, 0, out->ng);
  vstore3(s.ns, 0, out->ns);
  vstore3(s.dpdu, 0, out->dpdu);
  vstore3(s.dpdv, 0, out->dpdv);
  out->surface = s.surface;
  out->leaving = (uint)s.leaving;
  out->instance = hit.instance;
}

__attribute__((vec_type_hint(float8))) __kernel void scene_walk(SCENE_PARAMETERS, __global const RayRecord* rays, __global float4* steps, __global uint* counts, uint most,
                         uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  SCENE_STRUCTS;
  RayRecord ray = rays[i];
  uint n = 0;
  for (; n < most; n++) {
    const HitRecord hit = trace_closest(&tree, ray);
    if (hit.slot == CAPLET_NONE) break;
    const Surface s = surface_at(&tree, &surfaces, &ray, &hit);
    steps[(size_t)i * most + n] = (float4)(s.p, s.error);
    const float3 o = offset_origin(s.p, s.ng, s.error, (float3)(ray.dx, ray.dy, ray.dz));
    ray.ox = o.x;
    ray.oy = o.y;
    ray.oz = o.z;
  }
  counts[i] = n;
}
)";

}  // namespace

Shape shape_of(decltype(Shape::geometry) geometry, const glm::dmat4& world_from_object) {
  Shape shape;
  shape.geometry = std::move(geometry);
  shape.world_from_object = world_from_object;
  return shape;
}

FlatScene lower_shapes(std::vector<Shape> shapes) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes = std::move(shapes);
  return lower(scene);
}

namespace {

cl::Kernel kernel_of(const char* name, int width, const FlatScene& scene) {
  static std::map<std::tuple<int, int, bool>, Program> programs;
  const std::tuple key{width, scene.leaf_kind_bits, scene.has_chains};
  auto found = programs.find(key);
  if (found == programs.end()) {
    const std::string options =
        fmt::format("-DCAPLET_REAL_WIDTH={} -DCAPLET_LEAF_KIND_BITS={}{}", width,
                    scene.leaf_kind_bits, scene.has_chains ? " -DCAPLET_CHAINS" : "");
    found = programs
                .emplace(key,
                         Program::from_source(
                             test_device(), "scene probe",
                             flatten_kernels(std::string(scene_parameters) + kernel_text), options))
                .first;
  }
  return found->second.kernel(name);
}

}  // namespace

std::vector<SceneHit> trace(const FlatScene& scene, const std::vector<RayRecord>& rays, int width) {
  cl::Kernel kernel = kernel_of("scene_trace", width, scene);
  const Buffer<SceneHit> hits(test_device(), rays.size());
  const SceneOnDevice buffers(test_device(), scene, width);
  const auto ray_buffer = upload(test_device(), rays);
  buffers.set_arguments(kernel, ray_buffer, hits, static_cast<cl_uint>(rays.size()));
  launch(test_device(), kernel, rays.size(), 16);
  return hits.read();
}

std::vector<Walk> walk(const FlatScene& scene, const std::vector<RayRecord>& rays,
                       std::uint32_t most) {
  cl::Kernel kernel = kernel_of("scene_walk", test_width(), scene);
  const Buffer<WalkStep> steps(test_device(), rays.size() * most);
  const Buffer<std::uint32_t> counts(test_device(), rays.size());
  const SceneOnDevice buffers(test_device(), scene, test_width());
  const auto ray_buffer = upload(test_device(), rays);
  buffers.set_arguments(kernel, ray_buffer, steps, counts, static_cast<cl_uint>(most),
                        static_cast<cl_uint>(rays.size()));
  launch(test_device(), kernel, rays.size(), 16);
  const std::vector<WalkStep> all = steps.read();
  const std::vector<std::uint32_t> found = counts.read();
  std::vector<Walk> out(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(i * most);
    out[i].steps.assign(first, first + found[i]);
  }
  return out;
}

}  // namespace caplet::test
