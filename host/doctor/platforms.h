// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What OpenCL says of platforms and devices, asked for in a child process.
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
  std::string devices_error;  // what clGetDeviceIDs said; empty: success
  std::vector<DeviceFacts> devices;
};

/// What a driver, or all of them, answered.
struct Answer {
  ChildEnd end;
  std::string load_error;  // of dlopen
  std::vector<PlatformFacts> platforms;
  bool has_devices() const;
};

/// Variables set in the child.
using Variables = std::vector<std::pair<std::string, std::string>>;

/// Who the loader is; empty when it does not say. Loads no driver.
Loader ask_loader();
/// Loads the driver's library and asks its platforms, through the loader.
Answer ask_driver(const Driver& driver, const Loader& loader, double seconds);
/// The same of the driver that came with this program.
Answer ask_bundled(double seconds);
/// Asks all platforms, as any command of Caplet does.
Answer ask_all(const Variables& variables, double seconds);
/// Whether dlopen finds a library; false also when it crashes.
bool can_load(const std::string& library, double seconds);
/// Runs `test`, with CAPLET_SELF_TEST=1, on the device of this index.
ChildEnd test_device(int index, const Variables& variables, const std::function<void(const Device&)>& test, double seconds);

}  // namespace caplet::doctor
