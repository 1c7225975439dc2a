// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs the light kernels over a lowered scene.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "render/buffers.h"
#include "surface_points.h"

namespace caplet::test {

/// What light_sample returned; `pdf` 0: nothing. `occluded`: something of the scene lies between p
/// and the target.
struct SampledLight {
  glm::dvec3 wi{0}, target{0};
  double pdf = 0, radiance = 0;
  bool infinite = false, delta = false, occluded = false;
};

/// Where light is received: at p by the side with this normal, or by all sides where that is 0.
struct Receiver {
  glm::dvec3 p{0}, normal{0};
};
/// A light, CAPLET_NONE: none, and the chance that it had.
struct Choice {
  std::uint32_t light = 0;
  double chance = 0;
};

/// The device, its buffers for one scene, and the kernels.
class LightBench {
 public:
  /// Kernels: for the rows of the lists that a mask names.
  explicit LightBench(const FlatScene& scene, const RowMasks& rows = {});

  /// light_sample at p with `count` independent uniform random numbers (fixed seed), at wavelengths
  /// 450 to 600 nm; the radiance is that at the first.
  std::vector<SampledLight> sample(const glm::dvec3& p, std::size_t count);
  /// light_area_pdf of light `light` at p for the directions to `points`.
  std::vector<double> area_pdf(std::uint32_t light, const glm::dvec3& p,
                               const std::vector<SurfacePoint>& points);
  /// Radiance of the sky as seen from p, and its sampling density times the chance of selection,
  /// for unit directions.
  std::vector<glm::dvec2> sky(const std::vector<glm::dvec3>& directions,
                              const glm::dvec3& p = glm::dvec3(0));
  /// How many of every `step`th (a power of two) of all 2^32 random numbers choose each of up to 8
  /// lights; the ninth: how often the chance was not the light's own.
  std::vector<std::uint64_t> all_selections(std::uint32_t step);
  /// The light that light_select chooses by each of the numbers.
  std::vector<std::uint32_t> select(const std::vector<std::uint32_t>& u);
  /// The light that light_choose takes by each of the numbers.
  std::vector<Choice> choose(const Receiver& at, const std::vector<std::uint32_t>& u);
  /// light_chance of each of the first lights.
  std::vector<double> chances(const Receiver& at, std::size_t lights);

 private:
  /// Returns the number of the next argument.
  cl_uint bind_scene(cl::Kernel& kernel);
  Device device_;
  SceneBuffers scene_;
  Program* program_;
};

}  // namespace caplet::test
