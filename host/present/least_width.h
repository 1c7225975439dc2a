// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Widens lines that are thinner than a pixel, so that they are visible.
#pragma once

#include "scene/scene.h"

namespace caplet {

/// Makes every capsule and sphere of the scene at least FilmSettings::least_width pixels wide for
/// its film and camera: a smaller radius becomes half of that many footprints at the centre of its
/// end or sphere. In objects the footprints are the largest of their instances. Shapes under an
/// uneven scale grow by its smallest factor. Returns how many radii grew.
std::size_t widen_to_least(Scene& scene);

}  // namespace caplet
