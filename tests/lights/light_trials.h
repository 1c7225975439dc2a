// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What each light of kernels/shared/lights.def brings to the tests that all of them pass: one
// function a light, NAME_trial. A row of the list without its function does not link.
#pragma once

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace caplet::test {

struct LightTrial {
  Scene scene;  // one light of the kind, and nothing that casts a shadow on p
  glm::dvec3 p, n;
  /// At p, of a surface with normal n: in closed form. `per_white`: in units of the radiance that
  /// white of an image has, which is its space's illuminant and not 1 at every wavelength.
  double irradiance = 0;
  bool per_white = false;
  /// Light sampling chooses it; otherwise rays alone find it.
  bool is_sampled = true;
  bool is_delta = false, is_infinite = false;
};

#define LIGHT(name, ...) LightTrial name##_trial();
#include "shared/lights.def"
#undef LIGHT

}  // namespace caplet::test
