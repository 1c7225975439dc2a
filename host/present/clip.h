// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads clipping planes as people write them: by an axis and where the cut is.
#pragma once

#include <string>

#include "scene/scene.h"

namespace caplet {

/// Parses DIRECTION[=PLACE] to a clipping plane. DIRECTION leads to what is cut away: an axis of
/// the scene's file (x, -x, y, ...), "view" (towards the camera) or "x,y,z" of the world. PLACE is
/// where the cut is: the coordinate along the axis, the distance from the camera, or dot(unit
/// direction, p); or a share of the scene's extent that is kept, such as 30%. Without one half is
/// kept. Throws InputError that names `flag`.
ClipPlane parse_clip(const std::string& text, const Scene& scene, const std::string& flag);

}  // namespace caplet
