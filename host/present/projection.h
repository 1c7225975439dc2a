// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes a camera between perspective and parallel projection.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "scene/camera.h"

namespace caplet {

/// Makes the camera orthographic, or perspective, so that what lies at the depth of `middle`, a
/// point of the world, stays where it is in the picture. Sharpness stays as well. Does nothing if
/// the camera is so already. A perspective view has the field of view of automatic cameras, and its
/// place moves along its axis. Throws InputError that names `flag` for other cameras, and for a
/// perspective one that has `middle` behind it.
void change_projection(Camera& camera, bool to_orthographic, const glm::dvec3& middle,
                       const std::string& flag);

}  // namespace caplet
