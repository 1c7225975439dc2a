// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colour maps.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace caplet {

/// Returns a colour of viridis (Smith and van der Walt 2015, matplotlib), perceptually uniform from
/// dark blue to yellow: `part` is from 0 to 1, the colour linear sRGB.
glm::dvec3 viridis(double part);

/// Returns red for 0, white for 0.5 and blue for 1, straight between them on a screen, as chemists
/// draw negative and positive charges; linear sRGB.
glm::dvec3 red_white_blue(double part);

/// Returns the linear sRGB colour at `part`, 0 to 1, of a map's range.
using ColorMap = glm::dvec3 (*)(double part);

/// The number of colours that a map is drawn with, from `part` 0 to 1.
inline constexpr int map_steps = 64;

/// Returns the legend for numbers from `low` to `high`.
Legend map_legend(std::string title, std::string unit, double low, double high,
                  ColorMap map = viridis);

/// Returns the legend of names: those of the materials, which are diffuse and of one colour; none
/// where there are no materials.
std::optional<Legend> names_legend(std::string title, const std::vector<Material>& all,
                                   const std::vector<std::uint32_t>& materials);

/// Adds the names that `legend` lacks, if both tell names; without a title where theirs differ.
void add_names(Legend& legend, const Legend& more);

}  // namespace caplet
