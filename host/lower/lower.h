// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scene -> records, flat buffers, trees and light tables. The only room that decides layouts and indices.
#pragma once

#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// Throws InputError when a limit of the layout is exceeded (before memory is allocated).
FlatScene lower(const Scene& scene);

/// Cheap: nothing of the scene but its camera, film, filter, sampler and integrator is looked at.
FlatView lower_view(const Scene& scene);

}  // namespace caplet
