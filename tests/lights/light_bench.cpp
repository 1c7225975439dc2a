// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "light_bench.h"

#include <fmt/format.h>

#include <bit>
#include <map>
#include <random>

#include "support/test_device.h"

namespace caplet::test {

namespace {

const char* const kernel_text = R"(
#include "lights/lights.cl"
#include "trace/shadow.cl"
#include "trace/trace.cl"

#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) access(type) name,
#define GROUP_END(Type)
#define SCENE GROUP_TREE GROUP_SURFACES GROUP_SPECTRA GROUP_LIGHTS GROUP_MATERIALS uint scene_end
#define MAKE_SCENE                                                                                                    \
  const Scene scene = {{world, nodes, leaves, instances},                                                             \
                       {geometries, primitive_geometry, surface_materials, mesh_indices, mesh_normals, mesh_uvs},     \
                       {spectra, spectrum_tables},                                                                    \
                       {lighting, lights, light_data, light_alias, light_nodes, light_places, light_texels, light_cdf},       \
                       {materials, material_data, textures, texture_data, images, texels}};                           \
  const uint i = (uint)get_global_id(0);                                                                              \
  if (i >= count) return;                                                                                             \
  const float4 lambda = (float4)(450.0f, 500.0f, 550.0f, 600.0f)

__kernel void sample_lights(SCENE, float px, float py, float pz, __global const float* u, __global float* out, uint count) {
  MAKE_SCENE;
  const float3 p = (float3)(px, py, pz);
  LightSample s;
  const LightReceiver at = {p, CAPLET_NONE};
  const int some = light_sample(&scene, at, lambda, (uint)(u[3 * i] * 4294967296.0f), (float2)(u[3 * i + 1], u[3 * i + 2]), &s);
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
    ShadowTarget target;
    const RayRecord ray = shadow_ray(&s, p, &target);
    const HitRecord hit = trace_ray(&scene.tree, world_root(&scene.tree), ray, target.enough);
    o[10] = (float)!shadow_is_free(&scene.tree, &hit, target);
  }
}

__kernel void area_densities(SCENE, uint light, float px, float py, float pz, __global const float* points, __global float* out,
                             uint count) {
  MAKE_SCENE;
  const float3 p = (float3)(px, py, pz);
  Surface hit;
  hit.p = vload3(2 * i, points);
  hit.ng = vload3(2 * i + 1, points);
  hit.error = 0.0f;
  const LightReceiver at = {p, CAPLET_NONE};
  out[i] = light_area_pdf(&scene, light, at, &hit, normalize(hit.p - p)) + 0.0f * lambda.x;
}

__kernel void sky(SCENE, float px, float py, float pz, __global const float* directions, __global float* out, uint count) {
  MAKE_SCENE;
  const float3 p = (float3)(px, py, pz);
  const float3 wi = vload3(i, directions);
  out[2 * i] = light_infinite(&scene.spectra, &scene.lights, p, wi, lambda, 1.0f, 1).x;
  // With the density of the ray known, the weight gives away that of light sampling: w = 1 / (1 + pdf^2).
  const float weight = light_infinite(&scene.spectra, &scene.lights, p, wi, lambda, 1.0f, 0).x / out[2 * i];
  out[2 * i + 1] = sqrt(fmax(0.0f, 1.0f / weight - 1.0f));
}

// This takes from the 2^32 numbers every `step`th of the 2^shift from i << shift on: how many choose
// each of up to 8 lights, and whether every chance is the light's own.
__kernel void selections(SCENE, uint shift, uint step, __global uint* out, uint count) {
  MAKE_SCENE;
  uint counts[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  uint wrong = lambda.x > 0.0f ? 0u : 1u;
  for (uint k = 0; k < (1u << shift); k += step) {
    float chance;
    const uint chosen = light_select(&scene.lights, (i << shift) + k, &chance);
    ++counts[min(chosen, 7u)];
    wrong += chance != light_alias[chosen].probability;
  }
  for (uint k = 0; k < 8; ++k) out[9 * i + k] = counts[k];
  out[9 * i + 8] = wrong;
}

// Each of `count` random numbers chooses a light.
__kernel void select_lights(SCENE, __global const uint* u, __global uint* out, uint count) {
  MAKE_SCENE;
  float chance;
  out[i] = light_select(&scene.lights, u[i], &chance) + (lambda.x > 0.0f ? 0u : 1u);
}

// What is received at a point by the side with a normal, or by all sides where that is 0.
static inline LightReceiver receiver_of(__global const float* at) {
  const float3 n = vload3(1, at);
  const LightReceiver receiver = {vload3(0, at), dot(n, n) > 0.0f ? normal_bits(n) : CAPLET_NONE};
  return receiver;
}

// A choice by each of `count` random numbers: the light, and the bits of its chance.
__kernel void choices(SCENE, __global const float* at, __global const uint* u, __global uint* out, uint count) {
  MAKE_SCENE;
  const LightReceiver receiver = receiver_of(at);
  float chance = lambda.x;
  out[2 * i] = light_choose(&scene.lights, &receiver, u[i], &chance);
  out[2 * i + 1] = as_uint(chance);
}

// The chance of each light.
__kernel void chances(SCENE, __global const float* at, __global float* out, uint count) {
  MAKE_SCENE;
  const LightReceiver receiver = receiver_of(at);
  out[i] = light_chance(&scene.lights, i, &receiver) + 0.0f * lambda.x;
}
)";

Program& program_of(const Device& device, const RowMasks& rows, const FlatScene& scene) {
  static std::map<std::pair<RowMasks, std::string>, Program> built;
  const std::string options =
      fmt::format("-DCAPLET_REAL_WIDTH={} -DCAPLET_LEAF_KIND_BITS={}{}{}", test_width(),
                  scene.leaf_kind_bits, scene.light_nodes.empty() ? "" : " -DCAPLET_LIGHT_TREE",
                  scene.has_chains ? " -DCAPLET_CHAINS" : "");
  const auto found = built.find({rows, options});
  if (found != built.end()) return found->second;
  return built
      .emplace(
          std::pair(rows, options),
          Program::from_source(device, "light_bench", flatten_kernels(kernel_text, rows), options))
      .first->second;
}

}  // namespace

LightBench::LightBench(const FlatScene& scene, const RowMasks& rows)
    : device_(test_device()), scene_(device_, scene), program_(&program_of(device_, rows, scene)) {}

cl_uint LightBench::bind_scene(cl::Kernel& kernel) {
  cl_uint index = 0;
#define GROUP_BEGIN(Type, group) \
  {                              \
    const Type##Buffers& buffers = scene_.group;
#define BUFFER(name, type, access) kernel.setArg(index++, buffers.name.handle());
#define GROUP_END(Type) }
  GROUP_TREE GROUP_SURFACES GROUP_SPECTRA GROUP_LIGHTS GROUP_MATERIALS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
      kernel.setArg(index++, cl_uint{0});
  return index;
}

std::vector<SampledLight> LightBench::sample(const glm::dvec3& p, std::size_t count) {
  std::mt19937 engine(20240817);
  std::vector<float> u(3 * count);
  for (float& x : u) x = static_cast<float>(engine() >> 8) * 0x1p-24f;
  const Buffer<float> numbers(device_, std::span<const float>(u));
  Buffer<float> out(device_, 11 * count);
  cl::Kernel kernel = program_->kernel("sample_lights");
  cl_uint at = bind_scene(kernel);
  for (int k = 0; k < 3; ++k) kernel.setArg(at++, static_cast<float>(p[k]));
  kernel.setArg(at++, numbers.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(count));
  launch(device_, kernel, count, 1);
  const std::vector<float> values = out.read();
  std::vector<SampledLight> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* v = &values[11 * i];
    samples[i] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6],      v[7],
                  v[8] != 0,          v[9] != 0,          v[10] != 0};
  }
  return samples;
}

std::vector<double> LightBench::area_pdf(std::uint32_t light, const glm::dvec3& p,
                                         const std::vector<SurfacePoint>& points) {
  std::vector<float> flat;
  for (const SurfacePoint& point : points)
    for (const glm::dvec3& v : {point.p, point.n})
      for (int k = 0; k < 3; ++k) flat.push_back(static_cast<float>(v[k]));
  const Buffer<float> in(device_, std::span<const float>(flat));
  Buffer<float> out(device_, points.size());
  cl::Kernel kernel = program_->kernel("area_densities");
  cl_uint at = bind_scene(kernel);
  kernel.setArg(at++, light);
  for (int k = 0; k < 3; ++k) kernel.setArg(at++, static_cast<float>(p[k]));
  kernel.setArg(at++, in.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(points.size()));
  launch(device_, kernel, points.size(), 1);
  const std::vector<float> values = out.read();
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(points.size())};
}

std::vector<glm::dvec2> LightBench::sky(const std::vector<glm::dvec3>& directions,
                                        const glm::dvec3& p) {
  std::vector<float> flat;
  for (const glm::dvec3& d : directions)
    for (int k = 0; k < 3; ++k) flat.push_back(static_cast<float>(d[k]));
  const Buffer<float> in(device_, std::span<const float>(flat));
  Buffer<float> out(device_, 2 * directions.size());
  cl::Kernel kernel = program_->kernel("sky");
  cl_uint at = bind_scene(kernel);
  for (int k = 0; k < 3; ++k) kernel.setArg(at++, static_cast<float>(p[k]));
  kernel.setArg(at++, in.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(directions.size()));
  launch(device_, kernel, directions.size(), 1);
  const std::vector<float> values = out.read();
  std::vector<glm::dvec2> found;
  for (std::size_t i = 0; i < directions.size(); ++i)
    found.emplace_back(values[2 * i], values[2 * i + 1]);
  return found;
}

std::vector<std::uint64_t> LightBench::all_selections(std::uint32_t step) {
  constexpr std::size_t shift = 14, items = std::size_t{1} << (32 - shift);
  Buffer<std::uint32_t> out(device_, 9 * items);
  cl::Kernel kernel = program_->kernel("selections");
  cl_uint at = bind_scene(kernel);
  kernel.setArg(at++, static_cast<cl_uint>(shift));
  kernel.setArg(at++, step);
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
  cl::Kernel kernel = program_->kernel("select_lights");
  cl_uint at = bind_scene(kernel);
  kernel.setArg(at++, numbers.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(u.size()));
  launch(device_, kernel, u.size(), 1);
  return out.read();
}

namespace {

std::vector<float> floats_of(const Receiver& at) {
  std::vector<float> out;
  for (const glm::dvec3& v : {at.p, at.normal})
    for (int k = 0; k < 3; ++k) out.push_back(static_cast<float>(v[k]));
  return out;
}

}  // namespace

std::vector<Choice> LightBench::choose(const Receiver& at, const std::vector<std::uint32_t>& u) {
  const Buffer<float> receiver(device_, std::span<const float>(floats_of(at)));
  const Buffer<std::uint32_t> numbers(device_, std::span<const std::uint32_t>(u));
  Buffer<std::uint32_t> out(device_, 2 * u.size());
  cl::Kernel kernel = program_->kernel("choices");
  cl_uint index = bind_scene(kernel);
  kernel.setArg(index++, receiver.handle());
  kernel.setArg(index++, numbers.handle());
  kernel.setArg(index++, out.handle());
  kernel.setArg(index++, static_cast<cl_uint>(u.size()));
  launch(device_, kernel, u.size(), 1);
  const std::vector<std::uint32_t> values = out.read();
  std::vector<Choice> choices(u.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    choices[i] = {values[2 * i], std::bit_cast<float>(values[2 * i + 1])};
  return choices;
}

std::vector<double> LightBench::chances(const Receiver& at, std::size_t lights) {
  const Buffer<float> receiver(device_, std::span<const float>(floats_of(at)));
  Buffer<float> out(device_, lights);
  cl::Kernel kernel = program_->kernel("chances");
  cl_uint index = bind_scene(kernel);
  kernel.setArg(index++, receiver.handle());
  kernel.setArg(index++, out.handle());
  kernel.setArg(index++, static_cast<cl_uint>(lights));
  launch(device_, kernel, lights, 1);
  const std::vector<float> values = out.read();
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(lights)};
}

}  // namespace caplet::test
