// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet doctor`: looks at the machine, the drivers, the platforms and the devices, and names what is wrong. Drivers are only
// ever loaded in child processes, so that one that crashes or hangs is a finding.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "doctor/finding.h"
#include "doctor/platforms.h"
#include "doctor/registry.h"
#include "doctor/surroundings.h"

namespace caplet::doctor {

/// The finding about one driver. `needed`: no other offers a device, so a driver without a platform is wrong, not just unused.
Finding judge_driver(const Driver& driver, const Answer& answer, const Surroundings& machine, bool needed);
/// A platform and its number of devices. `needed` as above.
Finding judge_platform(const PlatformFacts& platform, bool needed);
/// What a device is, then what it lacks. `least_bytes`: device memory that a render needs at least.
Findings judge_device(const DeviceFacts& device, std::uint64_t least_bytes);
/// What is known of platforms, with its source.
Findings known_quirks(const std::vector<PlatformFacts>& platforms);

struct Options {
  std::string device;   // test this one alone, chosen as Device::choose does; empty: all
  double seconds = 30;  // for an answer of a driver; the self-test, which compiles, has four times as long
  /// Bytes of device memory for a full batch of paths, on a CPU or on another device.
  std::function<std::uint64_t(bool cpu)> least_bytes = [](bool) { return std::uint64_t{0}; };
  /// Throws RunError that says what a device gets wrong.
  std::function<void(const Device&)> test = self_test;
};

struct Diagnosis {
  Findings findings;
  std::vector<PlatformFacts> platforms;
  bool anything_wrong() const;
};

/// `tell` is called with each finding as soon as it is known. Throws InputError when there are devices and `options.device` is
/// none of them.
Diagnosis diagnose(const Surroundings& machine, const Options& options, const std::function<void(const Finding&)>& tell);

}  // namespace caplet::doctor
