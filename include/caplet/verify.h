// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Does a device compute right? Its hits beside those of a host reference that finds them by another method, ray by ray.
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
    std::uint64_t disagreements = 0;  // rays
    double worst = 0;                 // error of a hit, in units of the bound that is stated for it
    double seconds = 0;               // on the device
  };
  std::vector<OfDevice> devices;
  std::string text, json;  // the whole of it: for people, and for machines

  bool agrees() const {
    for (const OfDevice& one : devices)
      if (one.disagreements > 0) return false;
    return true;
  }
};

/// Throws RunError, InputError.
CAPLET_API VerifyReport verify(const Scene& scene, std::span<const Device> devices, const VerifyOptions& options = {});
/// On scenes of all shapes, made to be difficult.
CAPLET_API VerifyReport verify(std::span<const Device> devices, const VerifyOptions& options = {});

CAPLET_END
