// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts transforms and shape numbers of the public classes to the model's.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "caplet/shape.h"
#include "scene/edit.h"
#include "scene/motion.h"
#include "scene/scene.h"

namespace caplet::v0 {

glm::dmat4 to_model(const Transform& rows);
Transform to_public(const glm::dmat4& m);

/// Throws InputError where there are not as many times as transforms.
TransformKeys keys_of(const std::vector<double>& times, std::span<const Transform> transforms);

/// Shapes of the world are numbered first, then those of each object. Throws InputError for a
/// number without a shape.
ShapeAt place_of(const caplet::Scene& scene, std::uint32_t shape);

}  // namespace caplet::v0
