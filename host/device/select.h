// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the devices that a choice means.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

/// Returns the number of the chosen device in `devices`; rules and errors as Device::choose.
std::size_t select_device(const std::vector<DeviceInfo>& devices, const std::string& choice);
/// Returns the numbers of a list of choices, as Device::choose_several.
std::vector<std::size_t> select_devices(const std::vector<DeviceInfo>& devices,
                                        const std::string& choice);
/// Returns what select_devices, or select_device if not `several`, returns for `machine` with any
/// bundled devices behind it, if that does not depend on the bundled ones. Returns nothing if it
/// does; then they must be searched for.
std::optional<std::vector<std::size_t>> select_machine_devices(
    const std::vector<DeviceInfo>& machine, const std::string& choice, bool several);

}  // namespace caplet
