// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "scene/camera.h"
#include "scene/film.h"
#include "scene/integrator.h"
#include "scene/sampler.h"

namespace caplet {

/// A plane that cuts away what lies beyond it: only points p with dot(normal, p) <= offset are
/// there. Solids are closed by faces in the plane.
struct ClipPlane {
  glm::dvec3 normal;  // unit, in the world
  double offset;
};

/// How a scene is seen: all that is said of a picture, and nothing of what is in it.
struct View {
  Camera camera;
  PixelFilter filter;
  FilmSettings film;
  SamplerSettings sampler;
  IntegratorSettings integrator;
  std::optional<ClipPlane> clip;
};

}  // namespace caplet
