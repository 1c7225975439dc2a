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

/// In how many colours a colour bar shows it.
inline constexpr int color_map_steps = 64;

/// What its colours tell of values from `low` to `high`.
Legend legend_of(const std::string& title, const std::string& unit, double low, double high);

}  // namespace caplet
