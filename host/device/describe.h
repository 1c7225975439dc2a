// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Describes devices by what OpenCL says of them, as list_devices() returns it.
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

/// Returns the platforms of the machine's drivers, in the ICD loader's order, and behind them that
/// of the bundled driver. It is empty where there is none; never throws.
std::vector<FoundPlatform> find_platforms(Drivers drivers);
/// Throws cl::Error.
std::vector<cl::Device> devices_of(const FoundPlatform& platform);

/// Returns name and version, and bundled_mark. Throws cl::Error.
std::string platform_name(const FoundPlatform& platform);
/// Fills all but the index. Throws cl::Error.
DeviceInfo describe(const cl::Device& device, const std::string& platform);

}  // namespace caplet
