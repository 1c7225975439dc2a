// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/open_shutter.h"

#include <utility>

#include "scene/frozen.h"

namespace caplet {

void expose(FilmSettings& film, double seconds) {
  film.iso *= film.exposure_time / seconds;
  film.exposure_time = seconds;
}

Scene seen_from(Scene scene, double time, double exposure) {
  if (!(exposure > 0)) return frozen_at(std::move(scene), time);
  expose(scene.view.film, exposure);
  scene.view.film.shutter_open = time;
  return scene;
}

}  // namespace caplet
