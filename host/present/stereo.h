// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// One camera as two, for a pair of eyes.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace caplet {

enum class Eye { left, right };

struct Stereo {
  double separation = 0;  // of the eyes, in scene units; above 0
  std::optional<double>
      convergence;  // what is so far before the camera is at one place in both views; none: what is infinitely far
};

/// The camera of one eye: half the separation to the left or right of the scene's own, looking the same way. The screen window is
/// moved for convergence and the axis stays (off-axis cameras): there are no keystones, and no vertical parallax.
Camera camera_of_eye(const Scene& scene, const Stereo& stereo, Eye eye);

}  // namespace caplet
