// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/camera.h"
#include "scene/film.h"
#include "scene/integrator.h"
#include "scene/sampler.h"

namespace caplet {

/// How a scene is seen: all that is said of a picture, and nothing of what is in it.
struct View {
  Camera camera;
  PixelFilter filter;
  FilmSettings film;
  SamplerSettings sampler;
  IntegratorSettings integrator;
};

}  // namespace caplet
