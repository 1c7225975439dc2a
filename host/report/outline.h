// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The outline of a scene as text: the names of what is in it, in order, so that numbers of layers
// and crossings find their names where the shapes themselves are not there (lower/tree_file.h).
#pragma once

#include <string>

#include "scene/scene.h"

namespace caplet::report {

/// Returns the names of materials, shapes, objects and instances, and the files of the shapes, as
/// JSON.
std::string outline_text(const Scene& scene);

/// Adds what an outline names to a scene without content: shapes of the same kinds without
/// geometry, and materials that are all alike. Throws InputError that names `file`, which holds the
/// text, for a text that is no outline.
void add_outline(const std::string& text, const std::string& file, Scene& scene);

}  // namespace caplet::report
