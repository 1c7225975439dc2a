// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What each material of kernels/shared/materials.def brings to the tests that all of them pass: one
// function a material, in NAME_trial.cpp. A row of the list without its function does not link.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bsdf_device.h"
#include "scene/scene.h"

namespace caplet::test {

/// f |cos wi| and its solid-angle density from elsewhere: a closed form or another renderer.
struct KnownValue {
  BsdfParameters bsdf;
  Direction wo, wi;
  double value, pdf;  // a negative density: that it is not known
  double tolerance;   // relative, of both
};

/// What a sample must be: by u_component alone, for delta scattering.
struct KnownSample {
  BsdfParameters bsdf;
  Direction wo;
  float u_component;
  Direction wi;
  double weight, pdf;
  double tolerance;
};

struct BsdfTrial {
  /// Values are estimates and densities approximate (trait_stochastic): means are compared, and
  /// weights with values (estimates_test.cpp).
  bool estimates = false;
  bool bends = false;  // transmission scales radiance by the index squared
  bool reciprocal = true;
  /// One that scatters over directions, and the polar angles of wo at which it is tried.
  struct Case {
    BsdfParameters bsdf;
    std::vector<double> thetas;
  };
  std::vector<Case> cases;
  /// Two whose densities differ by little: samples of the first are not of the second.
  std::vector<std::array<BsdfParameters, 2>> unlike;
  std::vector<KnownValue> values;
  std::vector<KnownSample> samples;
  /// The material of the scene, which is lowered to this kind.
  Material model;
  /// The most that f |cos wi| integrates to; a sample weighs at most `heaviest` times that.
  double (*most)(const BsdfParameters& bsdf, bool inside);
  double heaviest = 1;
  /// Points along each side of a cell of the sphere (of 32 x 32) that resolve the density.
  int (*steps)(const BsdfParameters& bsdf, double cos_theta);
};

/// The roughnesses along u and v that rough materials are tried at.
inline constexpr std::array<std::array<float, 2>, 4> roughnesses = {
    {{0.05f, 0.05f}, {0.3f, 0.3f}, {0.8f, 0.8f}, {0.1f, 0.4f}}};

/// A material of the list and its trial.
struct MaterialOnTrial {
  int kind;
  std::string name;
  BsdfTrial trial;
};
/// In the order of the list.
const std::vector<MaterialOnTrial>& materials_on_trial();

#define MATERIAL(name, ...) BsdfTrial name##_trial();
#define CHOICE(name, ...)
#include "shared/materials.def"
#undef MATERIAL

}  // namespace caplet::test
