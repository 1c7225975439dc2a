// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat4x4.hpp>

#include "scene/scene.h"

namespace caplet {

/// Bounds of a csg solid under `world_from_csg`, from `bounds` that hold it: each side is moved inward to the first part, 1/32 of
/// the box long in each direction, that is not seen to be outside, and then again with 1/128 of the new box; or until a fixed
/// effort is spent (2048 parts a side). Where the solid's surfaces meet the side at a slant, a few parts lie between. The solid
/// is never cut. Empty when no part of the box can hold any of it.
Bounds tightened(const CsgShape& csg, const glm::dmat4& world_from_csg, const Bounds& bounds);

}  // namespace caplet
