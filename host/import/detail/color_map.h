// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colours that tell numbers.
#pragma once

#include <glm/vec3.hpp>

namespace caplet {

/// Viridis (Smith and van der Walt 2015, matplotlib), perceptually even from dark blue to yellow: `part` from 0 to 1 as linear
/// sRGB.
glm::dvec3 viridis(double part);

}  // namespace caplet
