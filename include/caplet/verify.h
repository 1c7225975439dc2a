// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Verifies a device: compares its hits, ray by ray, with a host reference that uses another method.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "caplet/device.h"
#include "caplet/scene.h"

CAPLET_BEGIN

struct VerifyOptions {
  std::uint64_t rays = 1'000'000;
  std::uint64_t seed = 0;
  std::function<void(std::uint64_t rays_done)> progress;
};

struct VerifyReport {
  struct OfDevice {
    DeviceInfo device;
    std::uint64_t rays = 0, hits = 0;
    std::uint64_t disagreements = 0;  // number of rays
    double worst = 0;                 // error of a hit, in units of its stated bound
    double seconds = 0;               // device time
  };
  std::vector<OfDevice> devices;
  std::string text, json;  // the full report, for people and for programs

  bool agrees() const {
    for (const OfDevice& one : devices)
      if (one.disagreements > 0) return false;
    return true;
  }
};

/// Throws RunError, InputError.
CAPLET_API VerifyReport verify(const Scene& scene, std::span<const Device> devices,
                               const VerifyOptions& options = {});
/// Verifies on difficult scenes with all kinds of shapes.
CAPLET_API VerifyReport verify(std::span<const Device> devices, const VerifyOptions& options = {});

CAPLET_END
