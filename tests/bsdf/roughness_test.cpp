// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Roughness from the scene to the density of a reflected direction, where it is small.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "device/device.h"
#include "lower/lower.h"
#include "support/test_device.h"

namespace caplet::test::roughness_test {
namespace {

const char* const kernel_text = R"CL(
#include "bsdf/bsdf.cl"

// This evaluates the first material at normal incidence: density straight back, and whether it is a
// mirror.
__kernel void straight_back(__global const MaterialRecord* materials, __global const float* material_data,
                            __global const SpectrumRecord* spectra, __global const float* spectrum_tables, __global float* out, uint count) {
  if (get_global_id(0) >= count) return;
  const Materials all = {materials, material_data, 0, 0, 0, 0};  // no textures
  const Spectra values = {spectra, spectrum_tables};
  const TexturePlace place = texture_place((float2)(0.0f));
  const Bsdf b = bsdf_make(&all, &values, 0, &place, (float4)(550.0f));
  const float3 up = (float3)(0.0f, 0.0f, 1.0f);
  float pdf;
  bsdf_eval(&b, up, up, &pdf);
  out[0] = pdf;
  out[1] = (float)bsdf_is_specular(&b);
}
)CL";

struct Straight {
  double density = 0;
  bool mirror = false;
};

Straight straight_back(double alpha_u, double alpha_v) {
  Scene scene;
  auto& metal = scene.materials.emplace_back().model.emplace<ConductorMaterial>();
  metal.eta = ConstantSpectrum{0.2};
  metal.k = ConstantSpectrum{3.9};
  metal.alpha_u = alpha_u;
  metal.alpha_v = alpha_v;
  scene.shapes.emplace_back().geometry = SphereShape{1};
  FlatScene flat = lower(scene);
  flat.spectrum_tables.push_back(0);  // never empty
  const Device& device = test_device();
  static const Program program =
      Program::from_source(device, "roughness", flatten_kernels(kernel_text), "");
  const Buffer<MaterialRecord> materials(device, std::span<const MaterialRecord>(flat.materials));
  const Buffer<SpectrumRecord> spectra(device, std::span<const SpectrumRecord>(flat.spectra));
  const Buffer<float> tables(device, std::span<const float>(flat.spectrum_tables)),
      data(device, std::span<const float>(flat.material_data)), out(device, 2);
  cl::Kernel kernel = program.kernel("straight_back");
  kernel.setArg(0, materials.handle());
  kernel.setArg(1, data.handle());
  kernel.setArg(2, spectra.handle());
  kernel.setArg(3, tables.handle());
  kernel.setArg(4, out.handle());
  kernel.setArg(5, cl_uint{1});
  launch(device, kernel, 1, 1);
  const std::vector<float> values = out.read();
  return {values[0], values[1] != 0};
}

// The density of visible normals at normal incidence is D = 1 / (pi alpha_u alpha_v), and that of
// directions a quarter of it.
double expected(double alpha_u, double alpha_v) {
  return 1 / (4 * std::numbers::pi * alpha_u * alpha_v);
}

TEST(Roughness, IsTakenAsItIsDownToAThousandth) {
  for (const auto& [u, v] :
       {std::pair(0.3, 0.3), std::pair(0.005, 0.02), std::pair(0.002, 0.002),
        std::pair(0.001, 0.001), std::pair(0.3, 0.0005), std::pair(0.0002, 0.001)}) {
    const Straight found = straight_back(u, v);
    EXPECT_FALSE(found.mirror) << u << ' ' << v;
    EXPECT_NEAR(found.density, expected(u, v), 1e-5 * expected(u, v))
        << u << ' ' << v;  // some twenty roundings
  }
}

// pbrt-v4: smooth where both are below 1e-3, otherwise 1e-4 at least.
TEST(Roughness, HasTheFloorsOfPbrt) {
  for (const auto& [u, v] :
       {std::pair(0.0, 0.0), std::pair(0.0009, 0.0), std::pair(0.00099, 0.00099)})
    EXPECT_TRUE(straight_back(u, v).mirror) << u << ' ' << v;
  for (const double small : {0.0, 0.00005}) {
    EXPECT_NEAR(straight_back(small, 0.3).density, expected(1e-4, 0.3), 1e-5 * expected(1e-4, 0.3))
        << small;
    EXPECT_NEAR(straight_back(0.3, small).density, expected(0.3, 1e-4), 1e-5 * expected(0.3, 1e-4))
        << small;
  }
}

}  // namespace
}  // namespace caplet::test::roughness_test
