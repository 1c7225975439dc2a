// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts a scene to records, flat buffers, trees and light tables. Only this room decides layouts
// and indices.
#pragma once

#include "lower/flat_scene.h"
#include "lower/linking.h"
#include "scene/scene.h"

namespace caplet {

/// Lowers a scene. Throws InputError when a limit of the layout is exceeded (before memory is
/// allocated).
FlatScene lower(const Scene& scene, const Linking& linking = {});

/// Lowers the view. It is cheap: it reads only the scene's camera, film, filter, sampler and
/// integrator.
FlatView lower_view(const Scene& scene);

}  // namespace caplet
