// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A driver that goes wrong: the program's own OpenCL calls go through functions here, which pass
// them on.
#pragma once

#include "device/device.h"

namespace caplet::test {

enum class Fault {
  launch_fails,  // CL_OUT_OF_RESOURCES
  launch_hangs,  // does not return
  read_fails,    // CL_OUT_OF_RESOURCES
  read_hangs,
};

/// As long as it lives, calls of the fault's kind to one device go wrong, from number `first` on
/// (0: at once). What hangs comes back, with an error, when this ends.
class BrokenDriver {
 public:
  BrokenDriver(const Device& device, Fault fault, int first);
  ~BrokenDriver();
  BrokenDriver(const BrokenDriver&) = delete;
  BrokenDriver& operator=(const BrokenDriver&) = delete;
  /// Calls of that kind that there have been.
  int calls() const;
};

}  // namespace caplet::test
