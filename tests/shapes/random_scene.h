// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes of all shapes, at random.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "scene/scene.h"

namespace caplet::test {

class SceneMaker {
 public:
  explicit SceneMaker(std::uint32_t seed) : random_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  glm::dvec3 direction() {
    const double z = uniform(-1, 1), phi = uniform(0, full_turn), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  /// Turned; half of them stretched along each axis, some of those mirrored; moved.
  glm::dmat4 placement(double reach) {
    glm::dmat4 m = glm::translate(glm::dmat4(1), reach * uniform(0, 1) * direction());
    if (below(4) != 0) m = glm::rotate(m, uniform(0, full_turn), direction());
    if (below(2) == 0)
      m = glm::scale(m, glm::dvec3(uniform(0.3, 3), uniform(0.3, 3),
                                   uniform(0.3, 3) * (below(3) == 0 ? -1 : 1)));
    return m;
  }
  Shape shape(int kind) {
    Shape out;
    out.geometry = geometry(kind);
    out.world_from_object = placement(4);
    out.material = static_cast<std::uint32_t>(below(20));
    if (below(2) == 0 && !std::holds_alternative<CsgShape>(out.geometry))
      for (std::size_t i = 0; i < surface_count(out); ++i)
        out.materials.push_back(static_cast<std::uint32_t>(below(20)));
    out.one_sided = below(4) == 0;
    out.reverse_orientation = below(4) == 0;
    return out;
  }
  static constexpr int kinds = 14;

 private:
  Cap cap() { return below(2) == 0 ? Cap::flat : below(2) == 0 ? Cap::round : Cap::open; }
  decltype(Shape::geometry) geometry(int kind);
  std::mt19937 random_;
};

/// Every kind twice or more, in the world and in objects, some of those placed twice.
Scene random_scene(std::uint32_t seed);

}  // namespace caplet::test
