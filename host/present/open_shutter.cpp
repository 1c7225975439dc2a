// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/open_shutter.h"

#include <utility>

#include "scene/frozen.h"

namespace caplet {

Scene seen_from(Scene scene, double time, double exposure) {
  if (!(exposure > 0)) return frozen_at(std::move(scene), time);
  FilmSettings& film = scene.view.film;
  film.iso *= film.exposure_time / exposure;
  film.exposure_time = exposure;
  film.shutter_open = time;
  return scene;
}

}  // namespace caplet
