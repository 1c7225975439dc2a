// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "light_bench.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

namespace caplet::test {

namespace {

constexpr double pi = std::numbers::pi;

const char* const kernel_text = R"(
#include "lights/lights.cl"
#include "trace/trace.cl"

#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) access(type) name,
#define GROUP_END(Type)
#define SCENE GROUP_TREE GROUP_SURFACES GROUP_SPECTRA GROUP_LIGHTS uint scene_end
#define MAKE_SCENE                                                                                                    \
  const Scene scene = {{world, nodes, leaves, instances},                                                             \
                       {geometries, primitive_geometry, surface_materials, mesh_indices, mesh_normals, mesh_uvs},     \
                       {spectra, spectrum_tables},                                                                    \
                       {lighting, lights, light_data, light_alias, environment_texels, environment_cdf}};             \
  const uint i = (uint)get_global_id(0);                                                                              \
  if (i >= count) return;                                                                                             \
  const float4 lambda = (float4)(450.0f, 500.0f, 550.0f, 600.0f)

__kernel void sample_lights(SCENE, float px, float py, float pz, __global const float* u, __global float* out, uint count) {
  MAKE_SCENE;
  const float3 p = (float3)(px, py, pz);
  LightSample s;
  const int some = light_sample(&scene, p, lambda, (uint)(u[3 * i] * 4294967296.0f), (float2)(u[3 * i + 1], u[3 * i + 2]), &s);
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
    o[10] = (float)trace_any(&scene.tree, ray);
  }
}

__kernel void area_densities(SCENE, uint light, float px, float py, float pz, __global const float* points, __global float* out,
                             uint count) {
  MAKE_SCENE;
  const float3 p = (float3)(px, py, pz);
  Surface hit;
  hit.p = vload3(2 * i, points);
  hit.ng = vload3(2 * i + 1, points);
  out[i] = light_area_pdf(&scene, light, p, &hit, normalize(hit.p - p)) + 0.0f * lambda.x;
}

__kernel void sky(SCENE, __global const float* directions, __global float* out, uint count) {
  MAKE_SCENE;
  const float3 wi = vload3(i, directions);
  out[2 * i] = light_infinite(&scene.spectra, &scene.lights, wi, lambda, 1.0f, 1).x;
  // With the density of the ray known, the weight gives away that of light sampling: w = 1 / (1 + pdf^2).
  const float weight = light_infinite(&scene.spectra, &scene.lights, wi, lambda, 1.0f, 0).x / out[2 * i];
  out[2 * i + 1] = sqrt(fmax(0.0f, 1.0f / weight - 1.0f));
}

// Of the 2^32 numbers, those from i << shift on, 2^shift of them: how many choose each of up to 8 lights, and whether every chance is
// the light's own.
__kernel void selections(SCENE, uint shift, __global uint* out, uint count) {
  MAKE_SCENE;
  uint counts[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  uint wrong = lambda.x > 0.0f ? 0u : 1u;
  for (uint k = 0; k < (1u << shift); ++k) {
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
)";

Program& program(const Device& device) {
  static Program built = Program::from_source(device, "light_bench", flatten_kernels(kernel_text), "-DCAPLET_REAL_WIDTH=8");
  return built;
}

Device& test_device() {
  static Device device = Device::choose("");
  return device;
}

}  // namespace

LightBench::LightBench(const FlatScene& scene) : device_(test_device()), scene_(device_, scene) {}

cl_uint LightBench::bind_scene(cl::Kernel& kernel) {
  cl_uint index = 0;
#define GROUP_BEGIN(Type, group) \
  {                              \
    const Type##Buffers& buffers = scene_.group;
#define BUFFER(name, type, access) kernel.setArg(index++, buffers.name.handle());
#define GROUP_END(Type) }
  GROUP_TREE GROUP_SURFACES GROUP_SPECTRA GROUP_LIGHTS
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
  cl::Kernel kernel = program(device_).kernel("sample_lights");
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

std::vector<glm::dvec2> LightBench::sky(const std::vector<glm::dvec3>& directions) {
  std::vector<float> flat;
  for (const glm::dvec3& d : directions)
    for (int k = 0; k < 3; ++k) flat.push_back(static_cast<float>(d[k]));
  const Buffer<float> in(device_, std::span<const float>(flat));
  Buffer<float> out(device_, 2 * directions.size());
  cl::Kernel kernel = program(device_).kernel("sky");
  cl_uint at = bind_scene(kernel);
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
  cl_uint at = bind_scene(kernel);
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
  cl_uint at = bind_scene(kernel);
  kernel.setArg(at++, numbers.handle());
  kernel.setArg(at++, out.handle());
  kernel.setArg(at++, static_cast<cl_uint>(u.size()));
  launch(device_, kernel, u.size(), 1);
  return out.read();
}

std::vector<SurfacePoint> surface_points(const Shape& shape, std::size_t count) {
  using Map = std::function<glm::dvec3(double, double)>;  // of [0, 1]^2
  std::vector<Map> parts;
  bool open = false;
  glm::dvec3 open_normal{0}, center{0};
  if (const auto* sphere = std::get_if<SphereShape>(&shape.geometry)) {
    parts.push_back([r = sphere->radius](double u, double v) {
      const double t = pi * u, f = 2 * pi * v;
      return r * glm::dvec3(std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t));
    });
  } else if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) {
    const glm::dvec3 a(capsules->p0[0]), b(capsules->p1[0]);
    const double ra = capsules->radius0[0], rb = capsules->radius1.empty() ? ra : capsules->radius1[0];
    const glm::dvec3 axis = b - a;
    const double length = glm::length(axis);
    const glm::dvec3 z = length > 0 ? axis / length : glm::dvec3(0, 0, 1);
    const glm::dvec3 x = glm::normalize(glm::cross(z, std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 y = glm::cross(z, x);
    // A band of a sphere, from polar angle t0 to t1 against z.
    const auto band = [=](glm::dvec3 at, double r, double t0, double t1) {
      return [=](double u, double v) {
        const double t = t0 + u * (t1 - t0), f = 2 * pi * v;
        return at + r * (std::sin(t) * (std::cos(f) * x + std::sin(f) * y) + std::cos(t) * z);
      };
    };
    if (length <= std::abs(ra - rb)) {
      parts.push_back(ra >= rb ? band(a, ra, 0, pi) : band(b, rb, 0, pi));
      center = ra >= rb ? a : b;
    } else {
      const double tangent = std::acos((ra - rb) / length);  // polar angle of the normals of the common tangent cone
      parts.push_back(band(a, ra, tangent, pi));
      parts.push_back(band(b, rb, 0, tangent));
      const Map from = band(a, ra, tangent, tangent), to = band(b, rb, tangent, tangent);
      parts.push_back([=](double u, double v) { return (1 - u) * from(0, v) + u * to(0, v); });
      center = (a + b) * 0.5;
    }
  } else if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry)) {
    open = true;
    const glm::dvec3 a(mesh->positions[0]), b(mesh->positions[1]), c(mesh->positions[2]);
    open_normal = glm::cross(b - a, c - a);
    parts.push_back([=](double u, double v) { return a + u * (b - a) + u * v * (c - b); });
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape.geometry)) {
    const glm::dvec3 axis = cylinder->p1 - cylinder->p0, z = glm::normalize(axis);
    const glm::dvec3 x =
        cylinder->radius * glm::normalize(glm::cross(z, std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 y = glm::cross(z, x);
    center = cylinder->p0 + 0.5 * axis;
    const auto around = [=](double v) { return std::cos(2 * pi * v) * x + std::sin(2 * pi * v) * y; };
    const glm::dvec3 p0 = cylinder->p0, p1 = cylinder->p1;
    const Map surfaces[3] = {[=](double u, double v) { return p0 + u * axis + around(v); },
                             [=](double u, double v) { return p0 + u * around(v); },
                             [=](double u, double v) { return p1 + u * around(v); }};
    const auto& lit = shape.emission->surfaces;
    for (std::uint32_t i = 0; i < 3; ++i)
      if ((lit.empty() || std::ranges::find(lit, i) != lit.end()) && (i == 0 || cylinder->caps[i - 1] == Cap::flat))
        parts.push_back(surfaces[i]);
  } else if (const auto* box = std::get_if<BoxShape>(&shape.geometry)) {
    const glm::dvec3 low = box->p0, size = box->p1 - box->p0;
    center = low + 0.5 * size;
    for (int face = 0; face < 6; ++face)
      parts.push_back([=](double u, double v) {
        glm::dvec3 at(0);
        at[face / 2] = face % 2;
        at[(face / 2 + 1) % 3] = u;
        at[(face / 2 + 2) % 3] = v;
        return low + at * size;
      });
  } else {
    open = true;
    const auto& disk = std::get<DiskShape>(shape.geometry);
    open_normal = {0, 0, 1};
    parts.push_back([=](double u, double v) {
      return glm::dvec3(disk.radius * u * std::cos(2 * pi * v), disk.radius * u * std::sin(2 * pi * v), disk.height);
    });
  }
  const glm::dmat4& m = shape.world_from_object;
  const auto place = [&](const glm::dvec3& p) { return glm::dvec3(m * glm::dvec4(p, 1)); };
  const glm::dvec3 world_open_normal = glm::transpose(glm::inverse(glm::dmat3(m))) * open_normal;
  const glm::dvec3 world_center = place(center);
  std::vector<SurfacePoint> points;
  // Roberts' sequence: the plane's counterpart of the golden ratio's multiples.
  const double plastic = 1.32471795724474602596;
  for (const Map& part : parts)
    for (std::size_t i = 0; i < count; ++i) {
      const double step = static_cast<double>(i) + 0.5, h = 1e-5;
      const double u = std::fmod(step / plastic, 1.0), v = std::fmod(step / (plastic * plastic), 1.0);
      const glm::dvec3 du = (place(part(u + h, v)) - place(part(u - h, v))) / (2 * h);
      const glm::dvec3 dv = (place(part(u, v + h)) - place(part(u, v - h))) / (2 * h);
      const glm::dvec3 across = glm::cross(du, dv);
      SurfacePoint point{place(part(u, v)), glm::normalize(across), glm::length(across) / static_cast<double>(count)};
      const glm::dvec3 outward = open ? world_open_normal : point.p - world_center;
      if (glm::dot(point.n, outward) < 0) point.n = -point.n;
      if (shape.reverse_orientation) point.n = -point.n;
      points.push_back(point);
    }
  return points;
}

}  // namespace caplet::test
