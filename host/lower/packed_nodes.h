// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Packs nodes of trees for devices that trace rays one at a time (kernels/trace/packed.cl). They
// are made of the wide ones, number for number, when a scene is sent.
#pragma once

#include <span>
#include <vector>

#include "shared/limits.h"

namespace caplet {

/// Packs CAPLET_NODE_FLOATS floats into CAPLET_PACKED_NODE_FLOATS. Each box as bytes is larger than
/// the exact one by 2^-13 of a step at least, which the slab test's rounding needs, and by two
/// steps at most, a step being the least power of two of which 255 span the node, or the last place
/// of its coordinates if that is more. Axes with coordinates beyond 2^126 are not tested.
void pack_node(std::span<const float, CAPLET_NODE_FLOATS> node,
               std::span<float, CAPLET_PACKED_NODE_FLOATS> packed);

/// Packs all of an array of nodes.
std::vector<float> packed_nodes(std::span<const float> nodes);

}  // namespace caplet
