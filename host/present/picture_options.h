// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Options of the picture's look: view direction, up axis, light and background.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// Parses three finite numbers separated by commas; no value for anything else.
std::optional<glm::dvec3> three_numbers(std::string_view text);

/// Parses "x", "-z"...: the unit vector along that axis. Throws InputError that names `flag`.
glm::dvec3 parse_axis(const std::string& text, const std::string& flag);

/// Returns the rotation that turns `up` to y: for an axis a quarter or half turn (z goes to y, y to
/// -z; x goes to y, y to -x; -y: about x), for other vectors the shortest.
glm::dmat3 turned_up(const glm::dvec3& up);

/// Parses a view to the unit vector toward the viewer in the world: front (z where y is up), back,
/// left, right (x), top, bottom, iso (all three alike), relative to `up`, or "x,y,z" of the world.
/// Throws InputError that names `flag`.
glm::dvec3 parse_view(const std::string& text, const glm::dvec3& up, const std::string& flag);

/// Returns the colour of "#rrggbb", linear sRGB; none for any other text.
std::optional<glm::dvec3> hex_color(std::string_view text);

/// Parses "transparent", the name of a colour, "#rrggbb" or "r,g,b" (sRGB, from 0 to 1); anything
/// else is a file that `images` reads. Throws InputError that names `flag`.
Backdrop parse_backdrop(const std::string& text, const ImageReader& images,
                        const std::string& flag);

/// Parses "auto", or stops from -most_stops to most_stops. Throws InputError that names `flag`.
PreviewExposure parse_exposure(const std::string& text, const std::string& flag);

/// Replaces the scene's lights (emissive shapes stay) by lights around the camera, which do not
/// follow it later: "studio", "dramatic" (a hard light from one side), "flat" (uniform light:
/// places deep among others are dark). Throws InputError that names `flag`.
void set_light(Scene& scene, const std::string& name, const std::string& flag);

/// Turns lights whose images are presets to the present camera.
void turn_lights_to_camera(Scene& scene);

}  // namespace caplet
