// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Connects the sessions of host/render with the public classes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "caplet/film.h"
#include "caplet/render.h"
#include "film/film_file.h"
#include "lower/fingerprint.h"
#include "lower/flat_scene.h"
#include "post/scale_bar.h"
#include "render/session.h"
#include "scene/scene.h"

namespace caplet::v0 {

/// Returns the layers of a film with those on request. Throws InputError if they do not go
/// together.
Layers layers_with(const ExtraLayers& extra);

/// Throws InputError when a target is out of range, or does not go with the sampler.
void check_noise(const NoiseTarget& target, const SamplerSettings& sampler);

/// The work of a session since its film was empty.
struct SessionRuns {
  double seconds = 0;
  bool interrupted = false;

  /// Adds the next samples and returns how many were finished.
  std::uint32_t render(caplet::Session& session, std::uint32_t samples,
                       const RenderOptions& options);
  /// Gives pixels what they need for a noise and returns the noise that the film has.
  double render_to(caplet::Session& session, const NoiseTarget& target,
                   const RenderOptions& options);
  /// Returns the present film of `scene`, whose flat arrays and view these are. `known`: hashes
  /// of the arrays.
  Film film(caplet::Session& session, const caplet::Scene& scene, const FlatScene& flat,
            const FlatView& view, SceneFingerprint& known);
  /// Returns what the session's film is of.
  FilmOrigin origin(const caplet::Session& session, const FlatScene& flat, const FlatView& view,
                    SceneFingerprint& known);
  /// Starts with what other runs have rendered.
  void resume(const SavedFilm& film);

 private:
  std::string scene_hash_, view_hash_;  // after the first film
  std::map<std::string, std::string> before_;
  std::shared_ptr<const post::Sight> sight_;  // of the scene, after the first film
};

}  // namespace caplet::v0
