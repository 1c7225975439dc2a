// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which of some devices a choice means.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

/// The number of the chosen device in `devices`; rules and errors as Device::choose.
std::size_t select_device(const std::vector<DeviceInfo>& devices, const std::string& choice);
/// Those of a list, as Device::choose_several.
std::vector<std::size_t> select_devices(const std::vector<DeviceInfo>& devices, const std::string& choice);
/// What select_devices, or select_device if not `several`, gives for `machine` with any bundled devices behind it, where that
/// does not depend on them; none where it does, so that they must be looked for.
std::optional<std::vector<std::size_t>> select_machine_devices(const std::vector<DeviceInfo>& machine, const std::string& choice,
                                                               bool several);

}  // namespace caplet
