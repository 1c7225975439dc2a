// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The first use of a device: its self-test in a process of its own, so that a driver that crashes or hangs is told of.
#pragma once

#include <vector>

#include "render/known_answers.h"

namespace caplet::cli {

/// try_device (render/known_answers.h), when it is due, by running this program again. Throws WrongDevice with what the test
/// says, or RunError with how the driver ended it; also when interrupted.
void try_device_apart(const Device& device, const Trial& trial);
/// Returns those of several devices that pass; the others are warned of. If none passes, throws the
/// error of the last one.
std::vector<Device> tried_apart(const std::vector<Device>& devices, const Trial& trial);

}  // namespace caplet::cli
