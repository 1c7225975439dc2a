// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes that go on in the next one, as the residues of a cartoon do.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/shape.h"

namespace caplet::post {

/// Returns a number for each shape of the world: the least of those that go on in each other. A
/// mesh goes on in the next shape where its last vertex is one of the next one's, with the same
/// normal; a tube of capsules where its last end is the beginning of one of the next one's, of the
/// same radius.
std::vector<std::uint32_t> joined_objects(const std::vector<Shape>& shapes);

}  // namespace caplet::post
