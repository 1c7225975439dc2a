// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/scene.h"

namespace caplet {

/// Lets a scene go on towards that of the next frame while the shutter is open, for a share of the
/// time between the two, in (0, 1]. Capsules go straight where a shape has as many in both,
/// vertices of meshes where it has the same faces; instances and a camera of the file move as
/// AnimatedTransform; all else rests. Scenes that move by themselves do not change. The picture
/// stays as bright as it is.
void move_to_next_frame(Scene& scene, const Scene& next, double share);

}  // namespace caplet
