// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images of lights around a camera. Their z is up, x toward the viewer, y to the viewer's right.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/lights/infinite.h"
#include "scene/scene.h"

namespace caplet {

/// These are the names in scene files; the first is the default of files without a light.
inline constexpr const char* studio_preset = "studio";
inline constexpr const char* dramatic_preset = "dramatic";
std::vector<std::string> light_presets();

/// Returns null when there is no preset of that name.
std::shared_ptr<const EnvironmentImage> light_preset(const std::string& name);
std::shared_ptr<const EnvironmentImage> studio_image();

/// Returns whether a light is a preset, which moves with the camera.
bool is_preset(const Light& light);

/// Returns InfiniteLight::world_from_light of a preset around this camera.
glm::dmat3 around(const Camera& camera);

}  // namespace caplet
