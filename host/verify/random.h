// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random numbers addressed by (seed, stream, index): ray number i does not depend on how the work
// is divided. Distributions are our own, because those of standard libraries differ.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace caplet::verify {

/// SplitMix64 (Steele, Lea and Flood 2014).
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index)
      : state_(mixed(mixed(mixed(seed) + stream) + index)) {}
  std::uint64_t bits() { return mixed(state_ += 0x9e3779b97f4a7c15u); }
  /// In [0, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// Returns 10 to a uniform power.
  double power(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  /// In [0, n).
  std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(unit() * static_cast<double>(n));
  }
  bool one_in(std::size_t n) { return below(n) == 0; }
  double sign() { return one_in(2) ? -1 : 1; }
  /// Returns a uniform point of the unit sphere.
  glm::dvec3 direction() {
    const double z = uniform(-1, 1), phi = uniform(0, 6.283185307179586),
                 r = std::sqrt((1 - z) * (1 + z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  /// Returns a uniform point in the unit ball.
  glm::dvec3 in_ball() { return std::cbrt(unit()) * direction(); }

 private:
  static std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace caplet::verify
