// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Adds camera and light to scenes whose files have only geometry.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace caplet {

/// Adds soft studio light around the scene's camera: one infinite image light with a large key
/// light from the upper left, a fill from the right, a rim light from behind and a dim, slightly
/// cool background. At infinity it adds no shape and lights scenes of any size alike: a white
/// surface that faces the key is displayed near 1. The scene must have no lights.
void add_studio_light(Scene& scene);

/// Frames the camera to the scene's shapes (frame_camera) and adds studio light around it; y is
/// taken as up.
void add_presentation(Scene& scene);

/// Returns whether the scene has a light or an emissive shape.
bool is_lit(const Scene& scene);

/// The margin of an automatic camera on each side, relative to half the image.
inline constexpr double frame_margin = 0.05;
/// The field of view of an automatic camera, of the shorter side: 35 degrees in radians.
inline constexpr double automatic_field_of_view = 0.6108652381980153;

/// Points the camera at the shapes and moves it so that they just fit the film's size, with a
/// margin; sets automatic_camera. It must be called again when the film's size changes.
/// Scene::framing sets direction, up axis and projection; by default the shapes decide: flat scenes
/// are seen face-on with a slight tilt, others three-quarter. A scene without shapes is framed as
/// the unit ball at its origin.
void frame_camera(Scene& scene);

/// Returns the bounds of all shapes. For a scene without shapes it is the box of the unit ball at
/// the origin, so that cameras and turntables need no special case.
Bounds bounds_or_unit_of(const Scene& scene);

/// Returns false where shapes have no finite extent, which validate() reports.
bool can_be_framed(const Scene& scene);

/// Moves an automatic camera, together with the studio light that belongs to it.
void move_camera(Scene& scene, const Camera& to);

/// Returns one of `n` easily distinguished diffuse colours (linear sRGB reflectance); the index
/// wraps.
glm::dvec3 palette_color(std::size_t index);

}  // namespace caplet
