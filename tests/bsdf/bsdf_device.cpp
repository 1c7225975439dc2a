// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "bsdf_device.h"

#include <cmath>
#include <random>

#include "support/test_device.h"

namespace caplet::test {

namespace {

const char* const kernels = R"CL(
#define CAPLET_MULTISCATTER
#include "bsdf/bsdf.cl"
#include "math/rng.cl"

// The places of what single materials keep, in the parameters from 14 on.
enum {
#define MATERIAL(name, traits)
#define KEPT(material, name, type) kept_##material##_##name,
#include "shared/materials.def"
#undef MATERIAL
};

#define BSDF uint kind, uint flags, uint key, __global const float* p

// The same value at all four wavelengths. Numbers of estimates differ from call to call.
static Bsdf given_bsdf(uint kind, uint flags, uint random, __global const float* p) {
  Bsdf b;
  b.kind = kind;
  b.flags = flags;
  b.random = random;
  b.reflectance = (float4)(p[0]);
  b.eta = (float4)(p[1]);
  b.k = (float4)(p[2]);
  b.alpha_u = p[3];
  b.alpha_v = p[4];
  b.transmittance = (float4)(p[5]);
  b.coat.eta = p[6];
  b.coat.alpha_u = p[7];
  b.coat.alpha_v = p[8];
  b.coat.thickness = p[9];
  b.coat.albedo = (float4)(p[10]);
  b.coat.g = p[11];
  b.coat.max_depth = (int)p[12];
  b.coat.samples = (int)p[13];
#define MATERIAL(name, traits)
#define KEPT(material, name, type) b.material##_##name = (type)(p[14 + kept_##material##_##name]);
#include "rows/materials.def"
#undef MATERIAL
  return b;
}
#define MAKE_BSDF Bsdf b = given_bsdf(kind, flags, hash_combine(hash_mix(key), i), p);

__kernel void sample_bsdf(BSDF, float4 wo, __global const float* u, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  MAKE_BSDF
  BsdfSample s;
  const int scattered = bsdf_sample(&b, wo.xyz, u[3 * i], (float2)(u[3 * i + 1], u[3 * i + 2]), &s);
  __global float* row = out + 12 * i;
  for (int c = 0; c < 12; ++c) row[c] = 0.0f;
  if (!scattered) return;
  vstore3(s.wi, 0, row);
  row[3] = s.pdf, row[4] = s.weight.x, row[5] = s.specular, row[6] = s.transmitted, row[7] = s.eta_scale;
  float pdf;
  row[8] = bsdf_eval(&b, wo.xyz, s.wi, &pdf).x;
  row[9] = pdf, row[10] = 1.0f, row[11] = s.weight.y;
}

__kernel void evaluate_bsdf(BSDF, __global const float* wo, __global const float* wi, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  MAKE_BSDF
  float pdf, exchanged_pdf;
  const float3 o = vload3(i, wo), d = vload3(i, wi);
  const float value = bsdf_eval(&b, o, d, &pdf).x;
  b.random = hash_mix(b.random + 1u);
  const float exchanged = bsdf_eval(&b, d, o, &exchanged_pdf).x;
  vstore4((float4)(value, pdf, exchanged, exchanged_pdf), i, out);
}

__kernel void integrate_bsdf(BSDF, float4 wo, int rows, int columns, int steps, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  MAKE_BSDF
  const float height = CAPLET_PI / (float)(rows * steps), width = 2.0f * CAPLET_PI / (float)(columns * steps);
  const int row = (int)i / columns * steps, column = (int)i % columns * steps;
  float densities = 0.0f, values = 0.0f;
  for (int y = 0; y < steps; ++y) {
    const float theta = ((float)(row + y) + 0.5f) * height;
    float line_densities = 0.0f, line_values = 0.0f;
    for (int x = 0; x < steps; ++x) {
      const float phi = ((float)(column + x) + 0.5f) * width;
      float pdf;
      b.random = hash_mix(b.random + 1u);
      line_values += bsdf_eval(&b, wo.xyz, (float3)(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)), &pdf).x;
      line_densities += pdf;
    }
    const float area = height * width * sin(theta);
    densities += area * line_densities;
    values += area * line_values;
  }
  out[i] = densities;
  out[count + i] = values;
}
)CL";

cl_float4 four(const Direction& d) { return {{d[0], d[1], d[2], 0}}; }

std::vector<float> flat(const std::vector<Direction>& directions) {
  std::vector<float> out;
  for (const Direction& d : directions) out.insert(out.end(), d.begin(), d.end());
  return out;
}

}  // namespace

std::vector<float> BsdfParameters::values() const {
  return {
      reflectance,  eta,          k,         alpha_u, alpha_v, transmittance, coat_eta,
      coat_alpha_u, coat_alpha_v, thickness, albedo,  g,       max_depth,     samples,
#define MATERIAL(name, traits)
#define KEPT(material, name, type) material##_##name,
#include "shared/materials.def"
#undef MATERIAL
  };
}

Direction direction(double theta, double phi) {
  return {static_cast<float>(std::sin(theta) * std::cos(phi)),
          static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
}

std::vector<float> random_numbers(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> u(count);
  for (float& value : u) value = static_cast<float>(random() >> 8) * 0x1p-24f;
  return u;
}

BsdfOnDevice::BsdfOnDevice(const RowMasks& rows)
    : device_(test_device()),
      program_(Program::from_source(device_, "bsdf_test", flatten_kernels(kernels, rows), "")) {}

cl::Kernel BsdfOnDevice::kernel(const char* name, const BsdfParameters& bsdf,
                                const Buffer<float>& values) const {
  cl::Kernel kernel = program_.kernel(name);
  kernel.setArg(0, cl_uint{bsdf.kind});
  kernel.setArg(1, cl_uint{bsdf.flags});
  kernel.setArg(2, cl_uint{key});
  kernel.setArg(3, values.handle());
  return kernel;
}

std::vector<SampleRow> BsdfOnDevice::sample(const BsdfParameters& bsdf, const Direction& wo,
                                            const std::vector<float>& u) const {
  const std::size_t count = u.size() / 3;
  const Buffer<float> numbers(device_, std::span<const float>(u));
  const Buffer<float> out(device_, 12 * count);
  const std::vector<float> values_of_bsdf = bsdf.values();
  const Buffer<float> parameters(device_, std::span<const float>(values_of_bsdf));
  cl::Kernel run = kernel("sample_bsdf", bsdf, parameters);
  run.setArg(4, four(wo));
  run.setArg(5, numbers.handle());
  run.setArg(6, out.handle());
  run.setArg(7, static_cast<cl_uint>(count));
  launch(device_, run, count, 64);
  const std::vector<float> values = out.read();
  std::vector<SampleRow> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* v = &values[12 * i];
    rows[i] = {{v[0], v[1], v[2]}, v[3], v[4], v[5], v[6], v[7], v[8], v[9], v[10], v[11]};
  }
  return rows;
}

std::vector<EvalRow> BsdfOnDevice::evaluate(const BsdfParameters& bsdf,
                                            const std::vector<Direction>& wo,
                                            const std::vector<Direction>& wi) const {
  const std::size_t count = wo.size();
  const std::vector<float> wo_values = flat(wo), wi_values = flat(wi);
  const Buffer<float> wo_buffer(device_, std::span<const float>(wo_values)),
      wi_buffer(device_, std::span<const float>(wi_values));
  const Buffer<float> out(device_, 4 * count);
  const std::vector<float> values_of_bsdf = bsdf.values();
  const Buffer<float> parameters(device_, std::span<const float>(values_of_bsdf));
  cl::Kernel run = kernel("evaluate_bsdf", bsdf, parameters);
  run.setArg(4, wo_buffer.handle());
  run.setArg(5, wi_buffer.handle());
  run.setArg(6, out.handle());
  run.setArg(7, static_cast<cl_uint>(count));
  launch(device_, run, count, 64);
  const std::vector<float> values = out.read();
  std::vector<EvalRow> rows(count);
  for (std::size_t i = 0; i < count; ++i)
    rows[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
  return rows;
}

std::vector<float> BsdfOnDevice::integrate(const BsdfParameters& bsdf, const Direction& wo,
                                           int rows, int columns, int steps) const {
  const auto count = static_cast<std::size_t>(rows * columns);
  const Buffer<float> out(device_, 2 * count);
  const std::vector<float> values_of_bsdf = bsdf.values();
  const Buffer<float> parameters(device_, std::span<const float>(values_of_bsdf));
  cl::Kernel run = kernel("integrate_bsdf", bsdf, parameters);
  run.setArg(4, four(wo));
  run.setArg(5, cl_int{rows});
  run.setArg(6, cl_int{columns});
  run.setArg(7, cl_int{steps});
  run.setArg(8, out.handle());
  run.setArg(9, static_cast<cl_uint>(count));
  launch(device_, run, count, 16);
  return out.read();
}

const BsdfOnDevice& bsdf_on_device() {
  static const BsdfOnDevice device;
  return device;
}

}  // namespace caplet::test
