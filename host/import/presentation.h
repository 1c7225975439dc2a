// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Camera, light and ground for files that bring geometry alone.
#pragma once

#include "scene/scene.h"

namespace caplet {

/// Frames the camera to the scene's bounds (three-quarter view for volumes, face-on for flat ones), and adds soft studio light
/// (a large key light, a dim constant sky). The scene has shapes with materials and no lights.
void add_presentation(Scene& scene);

/// `n` well-told-apart diffuse colours (linear sRGB reflectance), index wraps.
glm::dvec3 palette_color(std::size_t index);

}  // namespace caplet
