// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Answers to questions about a live scene.
#pragma once

#include <string>

#include "lower/live_scene.h"
#include "render/query.h"
#include "view/detail/clients.h"
#include "view/detail/eye_films.h"
#include "view/editor.h"

namespace caplet::view {

/// Answers what a pixel shows, what a thing is, and what a form says. What a pixel shows is what
/// was drawn there, with the least width of lines; lists of crossings are of the scene as it is.
/// Only the renderer's thread calls it.
class Picker {
 public:
  /// The scene, its editor and its films must outlive this. `device`: its name. Compiles the
  /// query's kernel.
  Picker(const LiveScene& live, const Editor& editor, const EyeFilms& films, std::string device);

  /// `shown`: the look that pages see.
  Text answer(const Question& question, const ShowView& shown);

 private:
  Text answer_to(const Ask& ask, const ShowView& shown);
  Text answer_to(const Describe& describe, const ShowView& shown);
  Text answer_to(const Form& form, const ShowView& shown);
  /// Returns the ray of the pixel of the full picture, even if a coarse one is rendered.
  RayRecord ray_at(const Ask& ask, const ShowView& shown) const;

  const LiveScene& live_;
  const Editor& editor_;
  const EyeFilms& films_;
  std::string device_;
  Query query_;
};

}  // namespace caplet::view
