// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Depths along a camera's axis.
#pragma once

#include <array>

#include "scene/camera.h"

namespace caplet {

/// Returns a, b, c, d such that a x + b y + c z + d is the depth of a point of the world along the
/// axis of a camera that rests, in scene units; 0 at the camera.
std::array<double, 4> depth_plane_of(const Camera& camera);

}  // namespace caplet
