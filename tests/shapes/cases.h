// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random primitives and rays for the shape tests: scales from 1e-3 to 1e3, coordinates up to 1e5, lengths up to 1e4 radii; rays
// that come from outside, far, inside and the surface, run along the axes, touch, and pass rims and ends.
// CAPLET_TEST_SCALE=N in the environment tries N times as many primitives (default 1: some 20 s on two cores in all).
#pragma once

#include <glm/vec3.hpp>
#include <random>
#include <string>
#include <vector>

#include "probe.h"

namespace caplet::test {

struct CaseSet {
  std::vector<FlatPrimitive> primitives;
  std::vector<std::uint32_t> which;  // of each ray
  std::vector<RayRecord> rays;
};

class CaseMaker {
 public:
  explicit CaseMaker(std::uint32_t seed) : random_(seed) {}
  /// `hard`: the full range of scales; otherwise radii 0.1 to 10 near the origin.
  FlatPrimitive primitive(int shape, bool hard);
  RayRecord ray(const FlatPrimitive& primitive);
  CaseSet set(int shape, bool hard, int primitives, int rays_each);
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  glm::dvec3 direction();  // uniform over the sphere

 private:
  glm::dvec3 surface_point(const FlatPrimitive& primitive, glm::dvec3* normal);
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  std::mt19937 random_;
};

/// CAPLET_TEST_SCALE, 1 to 1000; 1 when it is not set.
int test_scale();

/// Where a primitive lies and how large it is.
struct Extent {
  glm::dvec3 center;
  double radius;  // of the bounding ball
  double reach;   // L + r0 + r1, or the edge lengths: what kernel errors grow with
};
Extent extent_of(const FlatPrimitive& primitive);

}  // namespace caplet::test
