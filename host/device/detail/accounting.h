// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Counts the bytes of a device's buffers; copies of the device share the count.
#pragma once

#include <atomic>
#include <cstdint>

#include "device/device.h"

namespace caplet {

struct Device::Accounting {
  std::atomic<std::uint64_t> alive{0}, peak{0};

  void add(std::uint64_t bytes) {
    const std::uint64_t now = alive += bytes;
    std::uint64_t before = peak;
    while (before < now && !peak.compare_exchange_weak(before, now)) {
    }
  }
  void remove(std::uint64_t bytes) { alive -= bytes; }
};

}  // namespace caplet
