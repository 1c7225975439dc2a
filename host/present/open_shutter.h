// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/film.h"
#include "scene/motion.h"
#include "scene/scene.h"

namespace caplet {

/// Returns the keys of a motion while the film's shutter is open. `at`(u) returns the matrix at a
/// share u of that time, from 0 to 1; between five such matrices AnimatedTransform goes on.
template <class At>
TransformKeys keys_while_open(const FilmSettings& film, const At& at) {
  constexpr int pieces = 4;
  TransformKeys keys;
  for (int i = 0; i <= pieces; ++i) {
    const double u = static_cast<double>(i) / pieces;
    keys.push_back({film.shutter_open + u * film.exposure_time, at(u)});
  }
  return keys;
}

/// Keeps the shutter open for so many seconds; the picture stays as bright as it is.
void expose(FilmSettings& film, double seconds);

/// Returns the scene with a shutter that opens at `time` for `exposure` seconds, or, where these
/// are 0, with everything where it is at that time. The picture stays as bright as it is.
Scene seen_from(Scene scene, double time, double exposure);

}  // namespace caplet
