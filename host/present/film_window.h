// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes a picture's size and the part of it that is rendered.
#pragma once

#include <array>

#include "scene/scene.h"

namespace caplet {

/// Sets the film's size, 1 to 2^28 pixels. A crop keeps its relative place, and an automatic camera
/// is framed again.
void set_film_size(Scene& scene, int width, int height);

/// Sets the crop: x0, y0, x1, y1 in pixels from the top left, x1 and y1 excluded. Throws InputError
/// when it is empty or not within the image.
void set_crop(Scene& scene, const std::array<int, 4>& corners);

/// Throws InputError when the pixel (x, y), from the top left, is outside the image or its crop.
void check_pixel(const std::array<int, 2>& pixel, const FilmSettings& film);

}  // namespace caplet
