// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet doctor`: checks the machine, the drivers, the platforms and the devices, and reports
// problems. Drivers are loaded only in child processes, so that a crash or hang becomes a finding.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "doctor/finding.h"
#include "doctor/platforms.h"
#include "doctor/registry.h"
#include "doctor/surroundings.h"

namespace caplet::doctor {

/// Judges one driver. `needed`: no other driver offers a device, so one without a platform is wrong
/// and not just unused.
Finding judge_driver(const Driver& driver, const Answer& answer, const Surroundings& machine,
                     bool needed);
/// Judges a platform by its number of devices. `needed` is as above.
Finding judge_platform(const PlatformFacts& platform, bool needed);
/// Describes a device, then what it lacks. `least_bytes`: the least device memory of a render.
Findings judge_device(const DeviceFacts& device, std::uint64_t least_bytes);
/// Returns known problems of platforms, with their sources.
Findings known_quirks(const std::vector<PlatformFacts>& platforms);

struct Options {
  std::string device;   // tests only this one, chosen as in Device::choose; empty: all
  double seconds = 30;  // time limit for an answer of a driver; the self-test, which compiles, has
                        // four times as long
  /// Returns the bytes of device memory for a full batch of paths, on a CPU or on another device.
  std::function<std::uint64_t(bool cpu)> least_bytes = [](bool) { return std::uint64_t{0}; };
  /// Throws RunError that describes what a device computes wrong.
  std::function<void(const Device&)> test = self_test;
};

struct Diagnosis {
  Findings findings;
  std::vector<PlatformFacts> platforms;
  bool anything_wrong() const;
};

/// `tell` is called with each finding as soon as it is known. Throws InputError when devices exist
/// but `options.device` matches none of them.
Diagnosis diagnose(const Surroundings& machine, const Options& options,
                   const std::function<void(const Finding&)>& tell);

}  // namespace caplet::doctor
