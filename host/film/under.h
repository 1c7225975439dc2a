// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Evaluates a backdrop, pixel by pixel.
#pragma once

#include <array>

#include "film/image.h"
#include "scene/backdrop.h"

namespace caplet {

/// Returns the backdrop under the pixel (x, y) of a film of that size, from the top left:
/// displayed, linear sRGB, from 0 to 1. Transparent: 0. Images are filtered bilinearly, over as
/// many texels as a pixel covers.
std::array<float, 3> under(const Backdrop& backdrop, int width, int height, int x, int y);

/// Does the same in linear RGB of a colour space.
std::array<float, 3> under(const Backdrop& backdrop, int width, int height, int x, int y,
                           ColorSpace space);

}  // namespace caplet
