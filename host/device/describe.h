// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What OpenCL says of a device, as list_devices() gives it.
#pragma once

#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

struct FoundPlatform {
  cl::Platform platform;
  bool bundled = false;  // it came with this program
};

enum class Drivers { machine, bundled, all };

/// The platforms of the machine's drivers, in the ICD loader's order, and behind them that of the bundled driver. Empty where
/// there is none: throws never.
std::vector<FoundPlatform> find_platforms(Drivers drivers);
/// Throws cl::Error.
std::vector<cl::Device> devices_of(const FoundPlatform& platform);

/// Name and version, and bundled_mark. Throws cl::Error.
std::string platform_name(const FoundPlatform& platform);
/// All but the index. Throws cl::Error.
DeviceInfo describe(const cl::Device& device, const std::string& platform);

}  // namespace caplet
