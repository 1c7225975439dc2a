// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The second half of a device's self-test: the kernels that a command is about to use find, on some thousand rays whose crossings
// are known (known_rays.h), what they should. Arithmetic can be right on a device whose compiler gets functions of vectors wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

/// What a command is about to ask of a device.
struct Trial {
  std::uint64_t shapes = ~std::uint64_t{0};             // kernels built for scenes of these (FlatScene::shapes)
  bool render = false, nearest = false, lists = false;  // extend and connect; pick; pick_all and pick_list
};

/// Every kernel, for all shapes.
inline constexpr Trial whole_trial{~std::uint64_t{0}, true, true, true};

/// One line for each stage and kind of shape that is wrong, like "capsule: nearest crossing: 12 of 144 rays are wrong; ...".
/// Builds the programs of the device's encoding. Throws RunError when they do not build or run.
std::vector<std::string> known_answer_failures(const Device& device, const Trial& trial);

/// Whether try_device has something to do: $CAPLET_SELF_TEST is 1, or unset and the device has not passed this trial before with
/// this driver and these kernels.
bool needs_trial(const Device& device, const Trial& trial);

/// self_test(), then known_answer_failures(); remembered when all is well, so that the next needs_trial() says no. Throws
/// WrongDevice that says what is wrong. A driver may end the process here: see host/cli/trial.h.
void try_device(const Device& device, const Trial& trial);

/// Keeps in the cache that the device has passed; a cache that cannot be used is warned of.
void remember_trial(const Device& device, const Trial& trial);

}  // namespace caplet
