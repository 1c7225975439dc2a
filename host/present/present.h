// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Camera and light for files that bring geometry alone.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace caplet {

/// Frames the camera to the scene's shapes (frame_camera) and adds soft studio light around it: one infinite image light with a
/// large key light from the upper left, a fill from the right, a rim light from behind and a dim, slightly cool background. Being
/// at infinity it adds no shape and lights large and small scenes alike: a white surface that faces the key comes out near 1.
/// The scene has shapes with materials and no lights; y is taken as up.
void add_presentation(Scene& scene);

/// Whether anything gives light: a light, or a shape that emits.
bool is_lit(const Scene& scene);

/// What an automatic camera leaves free around all that it sees, on each side, of the half image.
inline constexpr double frame_margin = 0.05;

/// Points the camera at the shapes and moves it so that they just fit the film's size, with a margin; sets automatic_camera. To
/// be called again when the film's size has changed. Scene::framing says from where, which way up, and whether in perspective;
/// where it does not, flat scenes are seen face-on with a slight tilt, others three-quarter, by the shapes alone. A scene without
/// shapes is seen as if the unit ball stood at its origin.
void frame_camera(Scene& scene);

/// The box around all shapes. A scene without any counts as the unit ball about the origin: what looks at it, or turns around it,
/// then needs no case of its own.
Bounds bounds_or_unit_of(const Scene& scene);

/// False where shapes have no finite extent, which validate() reports.
bool can_be_framed(const Scene& scene);

/// Moves an automatic camera; the studio light that belongs to it goes with it.
void move_camera(Scene& scene, const Camera& to);

/// `n` well-told-apart diffuse colours (linear sRGB reflectance), index wraps.
glm::dvec3 palette_color(std::size_t index);

}  // namespace caplet
