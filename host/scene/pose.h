// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Poses: what one frame, or one key of an animation, changes of a scene.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "base/error.h"
#include "scene/edit.h"

namespace caplet {

/// Where a camera is and what it looks at.
struct LookAt {
  glm::dvec3 eye{0}, target{0}, up{0, 1, 0};
};

struct ScenePose {
  SourceLocation where;
  std::optional<double> time;  // seconds; of a key
  std::vector<SceneEdit> edits;
  std::optional<LookAt> look;  // of the View among the edits, where it was given so
};

}  // namespace caplet
