// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The image that is made, and the filter of its pixels.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "scene/backdrop.h"
#include "scene/spectrum.h"

namespace caplet {

struct PixelFilter {
  enum class Kind { box, triangle, gaussian, mitchell, sinc } kind = Kind::gaussian;
  double radius_x = 1.5, radius_y = 1.5;  // pixels
  double sigma = 0.5;                     // gaussian
  double b = 1.0 / 3, c = 1.0 / 3;        // mitchell
  double tau = 3;                         // sinc: cycles until the window's zero
};

struct FilmSettings {
  int width = 1280, height = 720;
  std::optional<std::array<int, 4>> crop;  // x0, x1, y0, y1 in pixels, half open
  std::string filename;                    // as the scene file states it
  double iso = 100, exposure_time = 1;     // film scale = exposure_time * iso / 100 (sensor-free rgb: 1 by default)
  double max_component_value = 0;          // of a sample's exposed XYZ; 0: none
  double white_balance = 0;                // kelvin: this daylight becomes the colour space's white; 0: nothing does
  ColorSpace space = ColorSpace::srgb;
  std::optional<Backdrop> backdrop = {};
  double least_width = 0;  // pixels: capsules and spheres are drawn no thinner (present/least_width.h); 0: as they are
};

}  // namespace caplet
