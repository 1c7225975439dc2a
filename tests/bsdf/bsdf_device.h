// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs the BSDF kernels on the device for the tests.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "device/device.h"
#include "shared/kinds.h"
#include "shared/records.h"

namespace caplet::test {

struct BsdfParameters {
  std::string name;
  uint kind = material_diffuse, flags = 0;
  float reflectance = 1, eta = 1.5f, k = 0, alpha_u = 0, alpha_v = 0;
  float transmittance = 0;
  float coat_eta = 1.5f, coat_alpha_u = 0, coat_alpha_v = 0, thickness = 0.01f, albedo = 0, g = 0,
        max_depth = 100, samples = 1;
  // Principled uses reflectance as base colour, k as sheen, albedo as the coat's colour,
  // coat_alpha_u as the coat's roughness.
#define MATERIAL(name, traits)
#define KEPT(material, name, type) float material##_##name = 0;
#include "shared/materials.def"
#undef MATERIAL

  /// All of them in the order in which kernels take them.
  std::vector<float> values() const;
};

using Direction = std::array<float, 3>;
Direction direction(double theta, double phi);

/// Returns numbers in [0, 1) from a fixed seed.
std::vector<float> random_numbers(std::size_t count, unsigned seed);

/// What a call of bsdf_sample gave, and bsdf_eval at the direction it took.
struct SampleRow {
  Direction wi;
  float pdf, weight, specular, transmitted, eta_scale, value, value_pdf, scattered, weight_second;
};
/// bsdf_eval one way and with wo and wi exchanged.
struct EvalRow {
  float value, pdf, exchanged, exchanged_pdf;
};

class BsdfOnDevice {
 public:
  /// Numbers of estimates are keyed by `key` and the number of the sample or value.
  uint key = 0;
  /// Kernels: for the rows of the lists that a mask names.
  explicit BsdfOnDevice(const RowMasks& rows = {});
  /// u: three numbers (component, u.x, u.y) a sample.
  std::vector<SampleRow> sample(const BsdfParameters& bsdf, const Direction& wo,
                                const std::vector<float>& u) const;
  std::vector<EvalRow> evaluate(const BsdfParameters& bsdf, const std::vector<Direction>& wo,
                                const std::vector<Direction>& wi) const;
  /// Integrals of the density and of f |cos| over cells of the sphere: `rows` of polar angle times
  /// `columns` of azimuth, by the midpoint rule over `steps` times `steps` points a cell. First the
  /// densities, then the values.
  std::vector<float> integrate(const BsdfParameters& bsdf, const Direction& wo, int rows,
                               int columns, int steps) const;

 private:
  cl::Kernel kernel(const char* name, const BsdfParameters& bsdf,
                    const Buffer<float>& values) const;
  Device device_;
  Program program_;
};

/// The one of the test program.
const BsdfOnDevice& bsdf_on_device();

}  // namespace caplet::test
