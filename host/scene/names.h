// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/scene.h"

namespace caplet {

/// Makes names and units valid UTF-8 (valid_utf8, base/utf8.h), because files may contain any
/// bytes. Paths keep their bytes, which are needed to open the files.
void make_names_valid(Scene& scene);

}  // namespace caplet
