// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colours that tell numbers.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "scene/scene.h"

namespace caplet {

/// Viridis (Smith and van der Walt 2015, matplotlib), perceptually even from dark blue to yellow: `part` from 0 to 1 as linear
/// sRGB.
glm::dvec3 viridis(double part);

/// So many colours a map is drawn with, from `part` 0 to 1.
inline constexpr int map_steps = 64;

/// What they tell of numbers from `low` to `high`.
Legend viridis_legend(std::string title, std::string unit, double low, double high);

}  // namespace caplet
