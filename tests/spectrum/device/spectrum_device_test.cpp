// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// math/spectrum.cl on the device against the host's double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "device/device.h"
#include "lower/detail/spectrum_color.h"
#include "lower/lower.h"
#include "lower/spectrum.h"
#include "support/test_device.h"

namespace caplet {
namespace {

const char* const kernels = R"CL(
#include "math/spectrum.cl"

#define SCENE __global const SpectrumRecord *spectra, __global const float *tables, __global const float *observer, \
              __global const float *wavelengths, __global const WorldRecord *world

__kernel void evaluate(SCENE, __global const float* lambda, __global float* out, uint count) {
  const Spectra values = {spectra, tables};
  const uint i = (uint)get_global_id(0);
  if (i < count) vstore4(spectrum_eval(&values, i / 64, vload4(i % 64, lambda)), i, out);
}
__kernel void texel(SCENE, __global const float* lambda, __global float* out, uint count, float4 value) {
  const uint i = (uint)get_global_id(0);
  if (i < count) vstore4(sigmoid_illuminant(tables + world->illuminant_table, value, vload4(i, lambda)), i, out);
}
// Per u: four wavelengths, four densities, then XYZ of spectrum 0 and what xyz_from_spectrum makes of its first wavelength alone.
__kernel void wavelengths_at(SCENE, __global const float* u, __global float* out, uint count) {
  const Spectra values = {spectra, tables};
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  float4 pdf;
  const float4 lambda = wavelengths_sample(wavelengths, u[i], &pdf);
  vstore4(lambda, 4 * i, out);
  vstore4(pdf, 4 * i + 1, out);
  const float4 radiance = spectrum_eval(&values, 0, lambda);
  vstore4((float4)(xyz_from_spectrum(observer, radiance, lambda, pdf), 0.0f), 4 * i + 2, out);
  vstore4((float4)(xyz_from_spectrum(observer, radiance, lambda, pdf * (float4)(0.25f, 0.0f, 0.0f, 0.0f)), 0.0f), 4 * i + 3, out);
}
)CL";

class SpectrumOnDevice : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    device_ = std::make_unique<Device>(test::test_device());
    program_ = std::make_unique<Program>(
        Program::from_source(*device_, "spectrum_test", flatten_kernels(kernels), ""));
  }
  static void TearDownTestSuite() {
    program_.reset();
    device_.reset();
  }

  /// Runs a kernel over the scene's tables; `bind` sets the arguments from number 5 on.
  template <class Bind>
  void run(const char* name, std::size_t count, Bind bind) {
    const Buffer<SpectrumRecord> spectra(*device_, std::span<const SpectrumRecord>(scene_.spectra));
    const Buffer<float> tables(*device_, std::span<const float>(scene_.spectrum_tables));
    const Buffer<float> observer(*device_, std::span<const float>(scene_.observer));
    const Buffer<float> wavelengths(*device_, std::span<const float>(scene_.wavelength_table));
    const Buffer<WorldRecord> world(*device_, std::span<const WorldRecord>(&scene_.world, 1));
    cl::Kernel kernel = program_->kernel(name);
    cl_uint argument = 0;
    for (const RawBuffer* buffer : std::initializer_list<const RawBuffer*>{
             &spectra, &tables, &observer, &wavelengths, &world})
      kernel.setArg(argument++, buffer->handle());
    bind(kernel);
    launch(*device_, kernel, count, 1);
    device_->finish();
  }

  static inline std::unique_ptr<Device> device_;
  static inline std::unique_ptr<Program> program_;
  FlatScene scene_;
};

TEST_F(SpectrumOnDevice, EveryKindAsOnTheHost) {
  SpectrumTable table(scene_, ColorSpace::srgb);
  table.add_reflectance(ConstantSpectrum{0.25});
  table.add_reflectance(RgbSpectrum{{0.9, 0.3, 0.1}, ColorSpace::srgb});
  table.add_unbounded(*named_spectrum("metal-Au-k"));
  table.add_illuminant(RgbSpectrum{{17, 12, 4}, ColorSpace::srgb});
  table.add_illuminant(BlackbodySpectrum{3000});
  table.add_reflectance(RgbSpectrum{{0, 0, 1}, ColorSpace::srgb});  // steep: coefficients are large
  std::mt19937 random(3);
  std::uniform_real_distribution<float> nm(360, 830);
  std::vector<float> lambda(256);
  for (float& value : lambda) value = nm(random);
  lambda[0] = 360, lambda[1] = 830, lambda[2] = 100,
  lambda[3] = 2000;  // beyond the tables: clamped, never read outside
  const Buffer<float> lambda_buffer(*device_, std::span<const float>(lambda));
  const std::size_t count = scene_.spectra.size() * 64;
  const Buffer<float> out(*device_, 4 * count);
  run("evaluate", count, [&](cl::Kernel& kernel) {
    kernel.setArg(5, lambda_buffer.handle());
    kernel.setArg(6, out.handle());
    kernel.setArg(7, static_cast<cl_uint>(count));
  });
  const std::vector<float> values = out.read();
  for (std::size_t s = 0; s < scene_.spectra.size(); ++s)
    for (std::size_t i = 0; i < 256; ++i) {
      const SpectrumRecord& r = scene_.spectra[s];
      const double place = std::clamp(double{lambda[i]}, 360.0, 830.0) - 360;
      const auto cell =
          std::min(static_cast<std::size_t>(place), std::size_t{CAPLET_LAMBDA_COUNT - 2});
      double expected = r.scale, tolerance = 1e-6 * r.scale;
      if (r.kind == spectrum_table || r.kind == spectrum_sigmoid_illuminant) {
        const double low = scene_.spectrum_tables[r.table + cell],
                     high = scene_.spectrum_tables[r.table + cell + 1];
        expected *= low + (place - static_cast<double>(cell)) * (high - low);
        // The fraction is exact; five roundings of the larger value follow.
        tolerance = 5 * 6e-8 * r.scale * std::max(low, high);
      }
      if (r.kind == spectrum_sigmoid || r.kind == spectrum_sigmoid_illuminant) {
        const double l = lambda[i], c0 = r.c0, c1 = r.c1, c2 = r.c2, x = (c0 * l + c1) * l + c2;
        expected *= sigmoid_value({c0, c1, c2}, l);
        // Horner's rule errs by 3 roundings of its largest terms; the slope of s is 1 / (2 (1 +
        // x^2)^1.5).
        const double polynomial =
            3 * 6e-8 * (std::abs(c0) * l * l + std::abs(c1) * l + std::abs(c2));
        tolerance = 2 * tolerance +
                    1.5 * std::max(1.0, expected) * (polynomial / std::pow(1 + x * x, 1.5) + 4e-7) +
                    1.5 * expected * polynomial;
      }
      EXPECT_NEAR(values[4 * (64 * s) + i], expected, tolerance)
          << "spectrum " << s << " at " << lambda[i];
    }
}

TEST_F(SpectrumOnDevice, TexelIsTheIlluminantTimesItsSigmoid) {
  SpectrumTable table(scene_, ColorSpace::srgb);
  table.add_illuminant(RgbSpectrum{{1, 1, 1}, ColorSpace::srgb});
  std::vector<float> lambda = {400, 450.5f, 555.25f, 700};
  const Buffer<float> lambda_buffer(*device_, std::span<const float>(lambda));
  const Buffer<float> out(*device_, 4);
  const std::array<float, 4> texel = environment_texel({2, 2, 2}, ColorSpace::srgb);
  run("texel", 1, [&](cl::Kernel& kernel) {
    kernel.setArg(5, lambda_buffer.handle());
    kernel.setArg(6, out.handle());
    kernel.setArg(7, cl_uint{1});
    kernel.setArg(8, cl_float4{{texel[0], texel[1], texel[2], texel[3]}});
  });
  const std::vector<float> values = out.read();
  const SpectrumSamples& light = illuminant(ColorSpace::srgb);
  EXPECT_NEAR(values[0], 2 * light[40], 2e-6);
  EXPECT_NEAR(values[1], light[90] + light[91], 2e-6);
  EXPECT_NEAR(values[3], 2 * light[340], 2e-6);
}

// A white emitter by 64 stratified samples is white, and densities are those of the wavelengths.
TEST_F(SpectrumOnDevice, WavelengthsAndTheirColor) {
  SpectrumTable table(scene_, ColorSpace::srgb);
  table.add_illuminant(RgbSpectrum{{1, 1, 1}, ColorSpace::srgb});
  constexpr std::size_t count = 64;
  std::vector<float> u;
  // The place within each stratum by the golden ratio: four wavelengths u + i/4 share strata, and
  // must not share places.
  for (std::size_t i = 0; i < count; ++i) {
    const double place = std::fmod(static_cast<double>(i) * 0.6180339887, 1.0);
    u.push_back(static_cast<float>((static_cast<double>(i) + place) / count));
  }
  const Buffer<float> u_buffer(*device_, std::span<const float>(u));
  const Buffer<float> out(*device_, 16 * count);
  run("wavelengths_at", count, [&](cl::Kernel& kernel) {
    kernel.setArg(5, u_buffer.handle());
    kernel.setArg(6, out.handle());
    kernel.setArg(7, static_cast<cl_uint>(count));
  });
  const std::vector<float> values = out.read();
  glm::dvec3 xyz(0), hero(0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double v = std::fmod(u[i] + 0.25 * static_cast<double>(lane), 1.0);
      const auto cell = static_cast<std::size_t>(v * 1024);
      const double low = scene_.wavelength_table[cell], high = scene_.wavelength_table[cell + 1];
      EXPECT_NEAR(values[16 * i + lane],
                  low + (v * 1024 - static_cast<double>(cell)) * (high - low), 1e-4);
      EXPECT_NEAR(values[16 * i + 4 + lane] * 1024 * (high - low), 1, 1e-6);
      if (lane == 3) continue;
      xyz[static_cast<int>(lane)] += values[16 * i + 8 + lane] / count;
      hero[static_cast<int>(lane)] += values[16 * i + 12 + lane] / count;
    }
  const std::array<double, 9> m = rgb_from_xyz(ColorSpace::srgb);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_NEAR(m[3 * row] * xyz.x + m[3 * row + 1] * xyz.y + m[3 * row + 2] * xyz.z, 1, 1e-3);
    // The hero wavelength alone, its density a quarter, has the same mean; one wavelength in 64
    // strata leaves a noise of 6e-3, and this is five times that.
    EXPECT_NEAR(m[3 * row] * hero.x + m[3 * row + 1] * hero.y + m[3 * row + 2] * hero.z, 1, 3e-2);
  }
}

TEST_F(SpectrumOnDevice, DensitiesIntegrateToOne) {
  // Sum over cells of density times width, as the kernel computes the density: 1024 cells of
  // probability 1/1024 each.
  SpectrumTable table(scene_, ColorSpace::srgb);
  table.add_reflectance(ConstantSpectrum{1});
  std::vector<float> u;
  for (std::size_t i = 0; i < 256; ++i) u.push_back((static_cast<float>(i) + 0.5f) / 1024);
  const Buffer<float> u_buffer(*device_, std::span<const float>(u));
  const Buffer<float> out(*device_, 16 * u.size());
  run("wavelengths_at", u.size(), [&](cl::Kernel& kernel) {
    kernel.setArg(5, u_buffer.handle());
    kernel.setArg(6, out.handle());
    kernel.setArg(7, static_cast<cl_uint>(u.size()));
  });
  const std::vector<float> values = out.read();
  double integral = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::size_t cell = i + 256 * lane;
      integral += double{values[16 * i + 4 + lane]} * (double{scene_.wavelength_table[cell + 1]} -
                                                       double{scene_.wavelength_table[cell]});
    }
  EXPECT_NEAR(integral, 1, 1e-6);
}

}  // namespace
}  // namespace caplet
