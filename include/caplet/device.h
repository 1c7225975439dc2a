// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The OpenCL devices that run renders and ray queries.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "caplet/error.h"
#include "caplet/export.h"

CAPLET_BEGIN

struct DeviceInfo {
  int index = 0;  // counts over all platforms
  std::string name, vendor, driver, version, platform;
  std::string type;  // "cpu", "gpu", "accelerator", "other"
  unsigned compute_units = 0;
  std::uint64_t global_bytes = 0;  // memory
  bool bundled = false;            // belongs to the driver that came with this library
};

/// Throws RunError in a forked process: OpenCL does not work if the process that was forked had
/// used it. Every call that needs a device does this check, and destructors then return nothing to
/// OpenCL. A program with locks around such calls should check before it waits for them.
CAPLET_API void check_process();

/// Names the program `caplet`. Kernels are then compiled by several of its processes at a time,
/// else by this process, one after the other. Call it before the first render or query.
CAPLET_API void set_program(const std::string& path);

/// Lists all devices; empty when there are none.
CAPLET_API std::vector<DeviceInfo> devices();

/// An open device. Copies refer to the same device.
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

/// `choice`: an index, "cpu", "gpu", "bundled" or part of a name; empty: a GPU if there is one,
/// else the first device. Throws InputError that lists the devices when none or several match, and
/// RunError when there is no device. Before its first render or query a device is tested once on
/// known answers, which includes the compilation of its kernels; a wrong device throws RunError.
CAPLET_API Device choose_device(const std::string& choice = {});
/// Chooses several: "all", or such choices separated by commas, all different.
CAPLET_API std::vector<Device> choose_devices(const std::string& choice);

CAPLET_END
