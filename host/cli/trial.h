// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The first use of a device: its self-test in a separate process, so that a crash or hang of the
// driver is reported.
#pragma once

#include <functional>
#include <vector>

#include "device/compilers.h"
#include "render/known_answers.h"

namespace caplet::cli {

/// Returns the kernels that a command is going to need on a device.
using NextJobs = std::function<std::vector<CompileJob>(const Device&)>;

/// Runs try_device (render/known_answers.h), when it is due, by starting this program again. What
/// `next` returns is compiled meanwhile. Throws WrongDevice with the test's message, or RunError
/// that says how the driver ended it; also when interrupted.
void try_device_apart(const Device& device, const Trial& trial, const NextJobs& next = {});
/// Returns those of several devices that pass, and warns of the others. If none passes, throws the
/// error of the last one.
std::vector<Device> tried_apart(const std::vector<Device>& devices, const Trial& trial,
                                const NextJobs& next);

}  // namespace caplet::cli
