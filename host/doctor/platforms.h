// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Queries OpenCL's platforms and devices in a child process.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "device/device.h"
#include "doctor/child.h"
#include "doctor/registry.h"

namespace caplet::doctor {

struct DeviceFacts {
  DeviceInfo info;
  bool available = true, compiler = true, little_endian = true;
  std::string profile = "FULL_PROFILE";
};

struct PlatformFacts {
  std::string name, vendor, version;
  std::string devices_error;  // the error of clGetDeviceIDs; empty: success
  std::vector<DeviceFacts> devices;
};

/// The answer of one driver, or of all of them.
struct Answer {
  ChildEnd end;
  std::string load_error;  // from dlopen
  std::vector<PlatformFacts> platforms;
  bool has_devices() const;
};

/// Environment variables set in the child.
using Variables = std::vector<std::pair<std::string, std::string>>;

/// Identifies the loader; empty when it does not say. Loads no driver.
Loader ask_loader();
/// Loads the driver's library and asks its platforms, through the loader.
Answer ask_driver(const Driver& driver, const Loader& loader, double seconds);
/// Asks the driver that came with this program in the same way.
Answer ask_bundled(double seconds);
/// Asks all platforms, as other commands of Caplet do.
Answer ask_all(const Variables& variables, double seconds);
/// Returns whether dlopen finds a library; false also when it crashes.
bool can_load(const std::string& library, double seconds);
/// Runs `test`, with CAPLET_SELF_TEST=1, on the device of this index.
ChildEnd test_device(int index, const Variables& variables,
                     const std::function<void(const Device&)>& test, double seconds);

}  // namespace caplet::doctor
