// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The records of records.def as the host and a device lay them out.
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

/// Sizes and offsets of every record in C++, in the order of records.def.
std::vector<RecordLayout> host_layout();

/// One line for each size or offset in which the device differs from `expected`; empty when they agree. Runs
/// kernels/probe/layout.cl. Throws RunError when it does not build or run.
std::vector<std::string> compare_layout(const Device& device, const std::vector<RecordLayout>& expected);
/// Against the host.
std::vector<std::string> compare_layout(const Device& device);

}  // namespace caplet
