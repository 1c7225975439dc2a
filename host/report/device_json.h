// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A device as `devices --json` and `doctor --json` print it.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.h"

namespace caplet::report {

nlohmann::ordered_json device_json(const DeviceInfo& device);

}  // namespace caplet::report
