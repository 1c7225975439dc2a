// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random points and rays, and tests that run in both widths of the kernels.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "floats.h"
#include "probe.h"

namespace caplet::test {

using glm::dvec3;

using std::numbers::pi;

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  dvec3 point() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }
  dvec3 direction() {
    const double z = (*this)(-1, 1), phi = (*this)(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937 engine_;
};

// Through memory: GCC 12 drops the rounding of a double to float and back where it vectorises it.
inline dvec3 to_float(const dvec3& x) {
  volatile float rounded[3] = {float(x.x), float(x.y), float(x.z)};
  return {rounded[0], rounded[1], rounded[2]};
}

inline RayRecord from_to(const dvec3& o, const dvec3& aim) {
  return make_ray(o, aim - to_float(o));
}

// Where a ray goes, from any side, near or far, along axes with zeros of either sign.
inline RayRecord ray_at(const dvec3& aim, double size, Random& random) {
  switch (random.below(4)) {
    case 0:
      return from_to(aim + size * random(0, 3) * random.direction(), aim);
    case 1:
      return from_to(aim + size * std::pow(10, random(0, 4)) * random.direction(), aim);
    case 2: {
      dvec3 d(random.below(2) == 0 ? 0.0 : -0.0);
      d[random.below(3)] = random.below(2) == 0 ? 1 : -1;
      return make_ray(aim - random(-1, 3) * size * d, d);
    }
    default:
      return make_ray(aim - random(-1, 3) * size * random.direction(), random.direction());
  }
}

class Widths : public testing::TestWithParam<int> {};

}  // namespace caplet::test
