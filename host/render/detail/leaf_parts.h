// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How the leaves of a scene are divided among buffers (kernels/math/leaves.cl).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "device/device.h"

namespace caplet {

/// Parts of `leaves`, or all of it as the first. A part begins every `distance` floats and goes on
/// beyond the begin of the next one by an eighth, the most that what begins in it may take.
struct LeafParts {
  std::size_t distance = 0;  // 0: the leaves are in one buffer
  std::array<std::span<const float>, 4> parts;
};

/// Divides leaves that are more than the device allows in one buffer, or than the environment
/// variable CAPLET_LEAF_PART says, in bytes. Those that are too long for four parts stay whole.
LeafParts leaf_parts(const Device& device, std::span<const float> leaves);

}  // namespace caplet
