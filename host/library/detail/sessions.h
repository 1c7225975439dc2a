// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Connects the sessions of host/render with the public classes.
#pragma once

#include <cstdint>
#include <memory>

#include "caplet/film.h"
#include "caplet/render.h"
#include "post/scale_bar.h"
#include "render/session.h"
#include "scene/scene.h"

namespace caplet::v0 {

/// The work of a session since its film was empty.
struct SessionRuns {
  double seconds = 0;
  bool interrupted = false;

  /// Adds the next samples and returns how many were finished.
  std::uint32_t render(caplet::Session& session, std::uint32_t samples,
                       const RenderOptions& options);
  /// Returns the present film of `scene`.
  Film film(caplet::Session& session, const caplet::Scene& scene);

 private:
  std::shared_ptr<const post::Sight> sight_;  // of the scene, after the first film
};

}  // namespace caplet::v0
