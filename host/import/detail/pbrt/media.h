// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <string>

#include "import/detail/pbrt/parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// Makes the medium of a MakeNamedMedium statement of an accepted type.
Medium make_medium(const std::string& type, const std::string& name, Parameters& parameters,
                   const glm::dmat4& world_from_medium);

}  // namespace caplet::pbrt
