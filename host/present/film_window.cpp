// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/film_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "present/present.h"

namespace caplet {

namespace {

/// Keeps the relative place of a crop when the picture's size changes; the result is never empty.
std::array<int, 4> rescaled(const std::array<int, 4>& crop, const FilmSettings& film, int width,
                            int height) {
  const auto scaled = [](int value, int to, int from) {
    return static_cast<int>(std::lround(static_cast<double>(value) * to / from));
  };
  std::array<int, 4> out{scaled(crop[0], width, film.width), scaled(crop[1], width, film.width),
                         scaled(crop[2], height, film.height),
                         scaled(crop[3], height, film.height)};
  out[0] = std::min(out[0], width - 1);
  out[1] = std::max(out[1], out[0] + 1);
  out[2] = std::min(out[2], height - 1);
  out[3] = std::max(out[3], out[2] + 1);
  return out;
}

}  // namespace

void set_film_size(Scene& scene, int width, int height) {
  FilmSettings& film = scene.view.film;
  if (film.crop) film.crop = rescaled(*film.crop, film, width, height);
  film.width = width;
  film.height = height;
  if (scene.automatic_camera) frame_camera(scene);
}

void set_crop(Scene& scene, const std::array<int, 4>& corners) {
  FilmSettings& film = scene.view.film;
  const auto [x0, y0, x1, y1] = corners;
  if (x0 >= x1 || y0 >= y1)
    throw InputError(
        fmt::format("'{},{},{},{}' is empty: x0 < x1 and y0 < y1 are needed", x0, y0, x1, y1));
  if (x0 < 0 || y0 < 0 || x1 > film.width || y1 > film.height)
    throw InputError(fmt::format("{},{},{},{} is not within the image of {}x{}", x0, y0, x1, y1,
                                 film.width, film.height));
  film.crop = {x0, x1, y0, y1};
}

void check_pixel(const std::array<int, 2>& pixel, const FilmSettings& film) {
  const auto [x, y] = pixel;
  if (x < 0 || y < 0 || x >= film.width || y >= film.height)
    throw InputError(fmt::format("{},{} is outside of the image of {}x{} (pixels count from 0,0)",
                                 x, y, film.width, film.height));
  if (!film.crop) return;
  const std::array<int, 4>& crop = *film.crop;
  if (x < crop[0] || x >= crop[1] || y < crop[2] || y >= crop[3])
    throw InputError(fmt::format("{},{} is outside of the crop {},{},{},{}", x, y, crop[0], crop[2],
                                 crop[1], crop[3]));
}

}  // namespace caplet
