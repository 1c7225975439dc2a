// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which material stands where a mix is, and what hair makes of its colour: from the scene to the
// device.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "device/device.h"
#include "lower/lower.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

const char* const kernel_text = R"CL(
#include "bsdf/bsdf.cl"

// The material chosen where material 0 is, by numbers (i + 1/2) / count; its absorption and reflectance.
__kernel void chosen(__global const MaterialRecord* materials, __global const float* material_data, __global const SpectrumRecord* spectra,
                     __global const float* spectrum_tables, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const Materials all = {materials, material_data, 0, 0};  // no textures
  const Spectra values = {spectra, spectrum_tables};
  const TexturePlace place = texture_place((float2)(0.0f));
  const uint material = bsdf_chosen(&all, &values, 0, &place, (float4)(550.0f), ((float)i + 0.5f) / (float)count);
  const Bsdf b = bsdf_make(&all, &values, material, &place, (float4)(550.0f));
  out[3 * i] = (float)material;
  out[3 * i + 1] = b.k.x;
  out[3 * i + 2] = b.reflectance.x;
}
)CL";

std::vector<float> look(const std::vector<Material>& materials, std::size_t count) {
  Scene scene;
  scene.materials = materials;
  scene.shapes.emplace_back().geometry = SphereShape{1};
  FlatScene flat = lower(scene);
  flat.spectrum_tables.push_back(0);  // never empty
  const Device& device = test_device();
  static const Program program =
      Program::from_source(device, "choice", flatten_kernels(kernel_text), "");
  const Buffer<MaterialRecord> records(device, std::span<const MaterialRecord>(flat.materials));
  const Buffer<SpectrumRecord> spectra(device, std::span<const SpectrumRecord>(flat.spectra));
  const Buffer<float> tables(device, std::span<const float>(flat.spectrum_tables)),
      data(device, std::span<const float>(flat.material_data)), out(device, 3 * count);
  cl::Kernel kernel = program.kernel("chosen");
  kernel.setArg(0, records.handle());
  kernel.setArg(1, data.handle());
  kernel.setArg(2, spectra.handle());
  kernel.setArg(3, tables.handle());
  kernel.setArg(4, out.handle());
  kernel.setArg(5, static_cast<cl_uint>(count));
  launch(device, kernel, count, 64);
  return out.read();
}

Material of(decltype(Material::model) model) {
  Material out;
  out.model = std::move(model);
  return out;
}

// A quarter of material 1, and of the rest (a mix again) three fifths are of 3 and two fifths of 2.
TEST(Mix, ChoosesByItsAmount) {
  const std::vector<Material> materials = {
      of(MixMaterial{{4, 1}, 0.25}), of(DiffuseMaterial{ConstantSpectrum{0.1}}),
      of(DiffuseMaterial{ConstantSpectrum{0.2}}), of(DiffuseMaterial{ConstantSpectrum{0.3}}),
      of(MixMaterial{{2, 3}, 0.6})};
  const std::size_t count = 4000;
  const std::vector<float> rows = look(materials, count);
  std::map<int, int> counts;
  for (std::size_t i = 0; i < count; ++i) {
    ++counts[static_cast<int>(rows[3 * i])];
    EXPECT_FLOAT_EQ(rows[3 * i + 2], 0.1f * rows[3 * i]);
  }
  EXPECT_NEAR(counts[1], 1000, 2);
  EXPECT_NEAR(counts[2], 1200, 2);
  EXPECT_NEAR(counts[3], 1800, 2);
  EXPECT_EQ(counts.size(), 3u);
}

TEST(Mix, AllOfOne) {
  for (const double amount : {0.0, 1.0}) {
    const std::vector<float> rows =
        look({of(MixMaterial{{1, 2}, amount}), of(DiffuseMaterial{}), of(DiffuseMaterial{})}, 1000);
    for (std::size_t i = 0; i < 1000; ++i) EXPECT_EQ(rows[3 * i], amount == 0 ? 1.0f : 2.0f);
  }
}

// Chiang et al. 2016, equation 9, at beta_n 0.3: 5.969 - 0.215 b + 2.532 b^2 - 10.73 b^3 + 5.574
// b^4 + 0.245 b^5 = 5.88841.
TEST(Hair, ColourBecomesAbsorption) {
  HairMaterial colored;
  colored.reflectance = ConstantSpectrum{0.4};
  EXPECT_NEAR(double{look({of(colored)}, 1)[1]}, std::pow(std::log(0.4) / 5.88841475, 2), 1e-6);
  HairMaterial dyed;
  dyed.sigma_a = ConstantSpectrum{0.7};
  EXPECT_EQ(look({of(dyed)}, 1)[1], 0.7f);
}

}  // namespace
}  // namespace caplet::test
