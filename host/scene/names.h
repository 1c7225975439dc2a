// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/scene.h"

namespace caplet {

/// Names and units of a scene as valid_utf8 has them (base/utf8.h), for files may hold any bytes. Paths stay as they are: files
/// are found by their bytes.
void make_names_valid(Scene& scene);

}  // namespace caplet
