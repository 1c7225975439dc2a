// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes two cameras, for a pair of eyes, from one.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace caplet {

enum class Eye { left, right };

struct Stereo {
  double separation = 0;              // of the eyes, in scene units; above 0
  std::optional<double> convergence;  // points at this distance before the camera coincide in both
                                      // views; none: points at infinity coincide
};

/// Returns the camera of one eye: half the separation to the left or right of the scene's own, in
/// the same direction. The screen window is shifted for convergence and the axis stays (off-axis
/// cameras), which avoids keystones and vertical parallax. An omnistereo camera stays, and has that
/// eye.
Camera camera_of_eye(const Scene& scene, const Stereo& stereo, Eye eye);

}  // namespace caplet
