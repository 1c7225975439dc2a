// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What OpenCL says of a device, as list_devices() gives it.
#pragma once

#include <string>

#include "device/device.h"

namespace caplet {

/// Name and version. Throws cl::Error.
std::string platform_name(const cl::Platform& platform);
/// All but the index. Throws cl::Error.
DeviceInfo describe(const cl::Device& device, const std::string& platform);

}  // namespace caplet
