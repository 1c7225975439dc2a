// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images of lights that stand around a camera. Their z is up, x toward the viewer, y to the viewer's right.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/lights/infinite.h"
#include "scene/scene.h"

namespace caplet {

/// What scene files call them; the first is the default of files without a light.
inline constexpr const char* studio_preset = "studio";
inline constexpr const char* dramatic_preset = "dramatic";
std::vector<std::string> light_presets();

/// Null when there is no preset of that name.
std::shared_ptr<const EnvironmentImage> light_preset(const std::string& name);
std::shared_ptr<const EnvironmentImage> studio_image();

/// Whether a light is a preset, which goes with the camera.
bool is_preset(const Light& light);

/// InfiniteLight::world_from_light of one that stands around this camera.
glm::dmat3 around(const Camera& camera);

}  // namespace caplet
