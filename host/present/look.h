// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How a picture looks, as people say it: from where, which way up, in what light, before what.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// "x", "-z"...: the unit vector along that axis. Throws InputError naming `flag`.
glm::dvec3 parse_axis(const std::string& text, const std::string& flag);

/// The rotation that turns `up` to y: of an axis a quarter or half turn (z goes to y, y to -z; x goes to y, y to -x; -y: about
/// x), of others the shortest.
glm::dmat3 turned_up(const glm::dvec3& up);

/// The unit vector toward the viewer, world: front (z where y is up), back, left, right (x), top, bottom, iso (all three alike),
/// as seen with `up` up, or "x,y,z" of the world. Throws InputError naming `flag`.
glm::dvec3 parse_view(const std::string& text, const glm::dvec3& up, const std::string& flag);

/// "transparent", the name of a colour, "#rrggbb", "r,g,b" (sRGB, from 0 to 1), else a file that `images` reads. Throws
/// InputError naming `flag`.
Backdrop parse_backdrop(const std::string& text, const ImageReader& images, const std::string& flag);

/// Replaces the scene's lights (shapes that emit stay) by one set-up around the camera, with which it does not move: "studio",
/// "dramatic" (a hard light from one side), "flat" (the same from everywhere: what is deep among others is dark). Throws
/// InputError naming `flag`.
void set_light(Scene& scene, const std::string& name, const std::string& flag);

/// Puts lights whose images are presets where they belong around the camera.
void turn_lights_to_camera(Scene& scene);

}  // namespace caplet
