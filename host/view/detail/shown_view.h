// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Views of a scene that the page asks for.
#pragma once

#include "scene/edit.h"
#include "view/messages.h"

namespace caplet::view {

/// Returns the look that shows what these settings say.
ShowView look_of(const View& own);
/// Returns the scene's own view.
inline ShowView look_of_scene(const Scene& scene) { return look_of(scene.view); }

/// Returns `own` as seen by `look`, with a pixel for each square of `scale` pixels. `eye`: 0 is the
/// left of a stereo pair.
View shown_view(const View& own, const ShowView& look, int scale, int eye);

}  // namespace caplet::view
