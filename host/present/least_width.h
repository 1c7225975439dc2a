// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lines thinner than a pixel, drawn as wide as they can be seen.
#pragma once

#include "scene/scene.h"

namespace caplet {

/// Makes every capsule and sphere of the scene, its film and camera as they are, at least FilmSettings::least_width pixels wide:
/// a radius below half of that many footprints at its end's (sphere's) middle becomes it. In objects the footprints are the
/// largest of their instances. Shapes that transforms stretch unevenly grow by their least stretch. Returns how many radii grew.
std::size_t widen_to_least(Scene& scene);

}  // namespace caplet
