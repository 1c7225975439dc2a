// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colour maps.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "scene/scene.h"

namespace caplet {

/// Returns a colour of viridis (Smith and van der Walt 2015, matplotlib), perceptually uniform from
/// dark blue to yellow: `part` is from 0 to 1, the colour linear sRGB.
glm::dvec3 viridis(double part);

/// The number of colours that a map is drawn with, from `part` 0 to 1.
inline constexpr int map_steps = 64;

/// Returns the legend for numbers from `low` to `high`.
Legend viridis_legend(std::string title, std::string unit, double low, double high);

}  // namespace caplet
