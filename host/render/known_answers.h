// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the second half of a device's self-test. It checks that the kernels that a command is
// about to use find the right crossings of some thousand rays whose crossings are known
// (known_rays.h). Arithmetic can be right on a device whose compiler gets functions of vectors
// wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/device.h"
#include "shared/shapes.h"

namespace caplet {

/// Trial is what a command is about to use on a device.
struct Trial {
  std::uint64_t shapes =
      ~std::uint64_t{0};  // kernels built for scenes of these (FlatScene::shapes)
  bool render = false, nearest = false,
       lists = false;  // extend and connect; pick; pick_all and pick_list
};

/// This trial has every kernel, for all shapes that rest: kernels for what moves are others.
inline constexpr Trial whole_trial{~shapes_with(trait_moves), true, true, true};

/// Returns one line for each stage and kind of shape that is wrong, like "capsule: nearest
/// crossing: 12 of 144 rays are wrong; ...". Builds the programs of the device's encoding. Throws
/// RunError when they do not build or run.
std::vector<std::string> known_answer_failures(const Device& device, const Trial& trial);

/// Returns whether try_device has something to do: $CAPLET_SELF_TEST is 1, or unset and the device
/// has not passed this trial before with this driver and these kernels.
bool needs_trial(const Device& device, const Trial& trial);

/// Runs self_test(), then known_answer_failures(). A pass is remembered, so that the next
/// needs_trial() returns false. Throws WrongDevice with the failures. A driver may end the process
/// here: see host/cli/trial.h.
void try_device(const Device& device, const Trial& trial);

/// Stores in the cache that the device has passed; a cache that cannot be used is warned of.
void remember_trial(const Device& device, const Trial& trial);

}  // namespace caplet
