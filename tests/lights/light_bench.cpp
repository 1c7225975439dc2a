// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "light_bench.h"

#include <fmt/format.h>

#include <random>

#include "support/test_device.h"

namespace caplet::test {

namespace {

const char* const kernel_text = R"(
#include "globals.cl"
#include "lights/lights.cl"
#include "trace/trace.cl"

#define SCENE                                                                                                                 \
  __global const ParamsRecord *params, __global const float *nodes, __global const float *leaves,                             \
      __global const InstanceRecord *instances, __global const GeometryRecord *geometries, __global const LightRecord *lights, \
      __global const float *light_data, __global const AliasRecord *light_alias, __global const SpectrumRecord *spectra,      \
      __global const float *spectrum_tables, __global const float *environment_texels, __global const float *environment_cdf, \
      __global const uint *primitive_geometry, __global const uint *surface_materials
#define MAKE_GLOBALS                          \
  Globals g;                                  \
  g.params = params;                          \
  g.nodes = nodes;                            \
  g.leaves = leaves;                          \
  g.instances = instances;                    \
  g.geometries = geometries;                  \
  g.lights = lights;                          \
  g.light_data = light_data;                  \
  g.light_alias = light_alias;                \
  g.spectra = spectra;                        \
  g.spectrum_tables = spectrum_tables;        \
  g.environment_texels = environment_texels;  \
  g.environment_cdf = environment_cdf;        \
  g.primitive_geometry = primitive_geometry;  \
  g.surface_materials = surface_materials;    \
  const uint i = (uint)get_global_id(0);      \
  if (i >= count) return;                     \
  const float4 lambda = (float4)(450.0f, 500.0f, 550.0f, 600.0f)

__kernel void sample_lights(SCENE, float px, float py, float pz, __global const float* u, __global float* out, uint count) {
  MAKE_GLOBALS;
  const float3 p = (float3)(px, py, pz);
  LightSample s;
  const int some = light_sample(&g, p, lambda, (uint)(u[3 * i] * 4294967296.0f), (float2)(u[3 * i + 1], u[3 * i + 2]), &s);
  __global float* o = out + 11 * i;
  for (int k = 0; k < 11; ++k) o[k] = 0.0f;
  if (!some) return;
  vstore3(s.wi, 0, o);
  vstore3(s.target, 0, o + 3);
  o[6] = s.pdf;
  o[7] = s.radiance.x;
  o[8] = (float)s.infinite;
  o[9] = (float)s.delta;
  if (!s.infinite) {
    const float3 d = s.target - p;
    RayRecord ray;
    ray.ox = p.x; ray.oy = p.y; ray.oz = p.z; ray.t_min = 0.0f;
    ray.dx = d.x; ray.dy = d.y; ray.dz = d.z; ray.t_max = 1.0f;
    o[10] = (float)trace_any(nodes, leaves, instances, params->root, ray);
  }
}

__kernel void area_densities(SCENE, uint light, float px, float py, float pz, __global const float* points, __global float* out,
                             uint count) {
  MAKE_GLOBALS;
  const float3 p = (float3)(px, py, pz);
  Surface hit;
  hit.p = vload3(2 * i, points);
  hit.ng = vload3(2 * i + 1, points);
  out[i] = light_area_pdf(&g, light, p, &hit, normalize(hit.p - p)) + 0.0f * lambda.x;
}

__kernel void sky(SCENE, __global const float* directions, __global float* out, uint count) {
  MAKE_GLOBALS;
  const float3 wi = vload3(i, directions);
  out[2 * i] = light_infinite(&g, wi, lambda, 1.0f, 1).x;
  // With the density of the ray known, the weight gives away that of light sampling: w = 1 / (1 + pdf^2).
  const float weight = light_infinite(&g, wi, lambda, 1.0f, 0).x / out[2 * i];
  out[2 * i + 1] = sqrt(fmax(0.0f, 1.0f / weight - 1.0f));
}

// Of the 2^32 numbers, those from i << shift on, 2^shift of them: how many choose each of up to 8 lights, and whether every chance is
// the light's own.
__kernel void selections(SCENE, uint shift, __global uint* out, uint count) {
  MAKE_GLOBALS;
  uint counts[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  uint wrong = lambda.x > 0.0f ? 0u : 1u;
  for (uint k = 0; k < (1u << shift); ++k) {
    float chance;
    const uint chosen = light_select(&g, (i << shift) + k, &chance);
    ++counts[min(chosen, 7u)];
    wrong += chance != light_alias[chosen].probability;
  }
  for (uint k = 0; k < 8; ++k) out[9 * i + k] = counts[k];
  out[9 * i + 8] = wrong;
}

// Each of `count` random numbers chooses a light.
__kernel void select_lights(SCENE, __global const uint* u, __global uint* out, uint count) {
  MAKE_GLOBALS;
  float chance;
  out[i] = light_select(&g, u[i], &chance) + (lambda.x > 0.0f ? 0u : 1u);
}
)";

template <class T>
RawBuffer upload(const Device& device, const std::vector<T>& values) {
  return RawBuffer(device, values.size() * sizeof(T), true, values.data());
}

Program& program(const Device& device) {
  static Program built = Program::from_source(device, "light_bench", flatten_kernels(kernel_text),
                                              fmt::format("-DCAPLET_REAL_WIDTH={}", test_width()));
  return built;
}

}  // namespace

LightBench::LightBench(const FlatScene& scene) : device_(test_device()) {
  scene_buffers_.push_back(upload(device_, std::vector<ParamsRecord>{scene.params}));
  scene_buffers_.push_back(upload(device_, scene.nodes));
  scene_buffers_.push_back(upload(device_, scene.leaves));
  scene_buffers_.push_back(upload(device_, scene.instances));
  scene_buffers_.push_back(upload(device_, scene.geometries));
  scene_buffers_.push_back(upload(device_, scene.lights));
  scene_buffers_.push_back(upload(device_, scene.light_data));
  scene_buffers_.push_back(upload(device_, scene.light_alias));
  scene_buffers_.push_back(upload(device_, scene.spectra));
  scene_buffers_.push_back(upload(device_, scene.spectrum_tables));
  scene_buffers_.push_back(upload(device_, scene.environment_texels));
  scene_buffers_.push_back(upload(device_, scene.environment_cdf));
  scene_buffers_.push_back(upload(device_, scene.primitive_geometry));
  scene_buffers_.push_back(upload(device_, scene.surface_materials));
}

void LightBench::bind_scene(cl::Kernel& kernel) {
  for (cl_uint i = 0; i < scene_buffers_.size(); ++i) kernel.setArg(i, scene_buffers_[i].handle());
}

std::vector<SampledLight> LightBench::sample(const glm::dvec3& p, std::size_t count) {
  std::mt19937 engine(20240817);
  std::vector<float> u(3 * count);
  for (float& x : u) x = static_cast<float>(engine() >> 8) * 0x1p-24f;
  const Buffer<float> numbers(device_, std::span<const float>(u));
  Buffer<float> out(device_, 11 * count);
  cl::Kernel kernel = program(device_).kernel("sample_lights");
  bind_scene(kernel);
  auto at = static_cast<cl_uint>(scene_buffers_.size());
  for (int k = 0; k < 3; ++k) kernel.setArg(at++, static_cast<float>(p[k]));
  kernel.setArg(at++, numbers.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(count));
  launch(device_, kernel, count, 1);
  const std::vector<float> values = out.read();
  std::vector<SampledLight> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* v = &values[11 * i];
    samples[i] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6], v[7], v[8] != 0, v[9] != 0, v[10] != 0};
  }
  return samples;
}

std::vector<double> LightBench::area_pdf(std::uint32_t light, const glm::dvec3& p, const std::vector<SurfacePoint>& points) {
  std::vector<float> flat;
  for (const SurfacePoint& point : points)
    for (const glm::dvec3& v : {point.p, point.n})
      for (int k = 0; k < 3; ++k) flat.push_back(static_cast<float>(v[k]));
  const Buffer<float> in(device_, std::span<const float>(flat));
  Buffer<float> out(device_, points.size());
  cl::Kernel kernel = program(device_).kernel("area_densities");
  bind_scene(kernel);
  auto at = static_cast<cl_uint>(scene_buffers_.size());
  kernel.setArg(at++, light);
  for (int k = 0; k < 3; ++k) kernel.setArg(at++, static_cast<float>(p[k]));
  kernel.setArg(at++, in.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(points.size()));
  launch(device_, kernel, points.size(), 1);
  const std::vector<float> values = out.read();
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(points.size())};
}

std::vector<glm::dvec2> LightBench::sky(const std::vector<glm::dvec3>& directions) {
  std::vector<float> flat;
  for (const glm::dvec3& d : directions)
    for (int k = 0; k < 3; ++k) flat.push_back(static_cast<float>(d[k]));
  const Buffer<float> in(device_, std::span<const float>(flat));
  Buffer<float> out(device_, 2 * directions.size());
  cl::Kernel kernel = program(device_).kernel("sky");
  bind_scene(kernel);
  auto at = static_cast<cl_uint>(scene_buffers_.size());
  kernel.setArg(at++, in.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(directions.size()));
  launch(device_, kernel, directions.size(), 1);
  const std::vector<float> values = out.read();
  std::vector<glm::dvec2> found;
  for (std::size_t i = 0; i < directions.size(); ++i) found.emplace_back(values[2 * i], values[2 * i + 1]);
  return found;
}

std::vector<std::uint64_t> LightBench::all_selections() {
  constexpr std::size_t shift = 14, items = std::size_t{1} << (32 - shift);
  Buffer<std::uint32_t> out(device_, 9 * items);
  cl::Kernel kernel = program(device_).kernel("selections");
  bind_scene(kernel);
  auto at = static_cast<cl_uint>(scene_buffers_.size());
  kernel.setArg(at++, static_cast<cl_uint>(shift));
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(items));
  launch(device_, kernel, items, 1);
  const std::vector<std::uint32_t> values = out.read();
  std::vector<std::uint64_t> counts(9, 0);
  for (std::size_t i = 0; i < values.size(); ++i) counts[i % 9] += values[i];
  return counts;
}

std::vector<std::uint32_t> LightBench::select(const std::vector<std::uint32_t>& u) {
  const Buffer<std::uint32_t> numbers(device_, std::span<const std::uint32_t>(u));
  Buffer<std::uint32_t> out(device_, u.size());
  cl::Kernel kernel = program(device_).kernel("select_lights");
  bind_scene(kernel);
  auto at = static_cast<cl_uint>(scene_buffers_.size());
  kernel.setArg(at++, numbers.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(u.size()));
  launch(device_, kernel, u.size(), 1);
  return out.read();
}

}  // namespace caplet::test
