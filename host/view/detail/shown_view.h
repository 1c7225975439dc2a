// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Views of a scene as the page asks for them.
#pragma once

#include "scene/edit.h"
#include "view/messages.h"

namespace caplet::view {

/// How the scene itself is looked at.
Look look_of_scene(const Scene& scene);

/// `own`, looked at as `look` says: a pixel for each square of `scale` pixels. `eye`: of a pair, 0 the left.
ViewEdit shown_view(const ViewEdit& own, const Look& look, int scale, int eye);

}  // namespace caplet::view
