// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Describes a device for `devices --json` and `doctor --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.h"

namespace caplet::report {

nlohmann::ordered_json device_json(const DeviceInfo& device);

}  // namespace caplet::report
