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

/// Does the same, but gives back the memory of linked capsules while it reads them, so that large
/// scenes take half of the memory. Their shapes are without capsules then. With media, whose order
/// depends on bounds of shapes, they stay.
FlatScene lower_and_release(Scene& scene, Linking linking = {});

/// Lowers the view. It is cheap: it reads only the scene's camera, film, filter, sampler and
/// integrator.
FlatView lower_view(const Scene& scene);

}  // namespace caplet
