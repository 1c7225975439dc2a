// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The OpenCL devices that renders and questions run on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "caplet/error.h"
#include "caplet/export.h"

CAPLET_BEGIN

struct DeviceInfo {
  int index = 0;  // over all platforms
  std::string name, vendor, driver, version, platform;
  std::string type;  // "cpu", "gpu", "accelerator", "other"
  unsigned compute_units = 0;
  std::uint64_t global_bytes = 0;  // memory
  bool bundled = false;            // of the driver that came with this library
};

/// OpenCL does not work in a process that was forked from one that had used it. There every call that needs a device throws this
/// RunError, and destructors give nothing back to OpenCL. A program with locks of its own around such calls asks before it waits
/// for them.
CAPLET_API void check_process();

/// All of them; empty when there is none.
CAPLET_API std::vector<DeviceInfo> devices();

/// An open device. Copies are the same one.
class CAPLET_API Device {
 public:
  Device(const Device&);
  Device(Device&&) noexcept;
  Device& operator=(const Device&);
  Device& operator=(Device&&) noexcept;
  ~Device();

  const DeviceInfo& info() const;

 private:
  friend struct Inside;
  struct Data;
  explicit Device(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

/// `choice`: an index, "cpu", "gpu", "bundled" or part of a name; empty: a GPU if there is one, else the first device. Throws
/// InputError that lists the devices when none or more than one is meant, and RunError when there is none. Before its first
/// render or question a device is tried once with answers that are known, which takes the time that its kernels take to compile;
/// a wrong one throws RunError.
CAPLET_API Device choose_device(const std::string& choice = {});
/// Several: "all", or such choices between commas, none of them twice.
CAPLET_API std::vector<Device> choose_devices(const std::string& choice);

CAPLET_END
