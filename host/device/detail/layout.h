// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Compares the layout of the records of records.def on the host and on a device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

struct FieldLayout {
  std::string name;
  std::uint32_t offset = 0, bytes = 0;
};

struct RecordLayout {
  std::string name;
  std::uint32_t bytes = 0;
  std::vector<FieldLayout> fields;
};

/// Returns sizes and offsets of every record in C++, in the order of records.def.
std::vector<RecordLayout> host_layout();

/// Returns one line for each size or offset in which the device differs from `expected`; it is
/// empty when they agree. Runs kernels/probe/layout.cl. Throws RunError when it does not build or
/// run.
std::vector<std::string> compare_layout(const Device& device,
                                        const std::vector<RecordLayout>& expected);
/// Compares with the host.
std::vector<std::string> compare_layout(const Device& device);

}  // namespace caplet
