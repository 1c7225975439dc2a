// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "support/test_device.h"

#include <fmt/format.h>

#include <iostream>

#include "support/device_choice.h"

namespace caplet::test {

namespace {

/// Prints the device once a process.
void announce(const Device& device) {
  static const bool done = [&] {
    const DeviceInfo& info = device.info();
    std::cout << fmt::format("[  DEVICE  ] {} {} ({}), {}, encoding {}", info.index, info.name,
                             info.type, info.platform, name_of(device.encoding()))
              << std::endl;
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace

Device test_device(Encoding encoding) {
  const std::string choice = test_device_choice();
  try {
    Device device = Device::choose(choice, encoding);
    announce(device);
    return device;
  } catch (const std::exception& error) {
    throw RunError(fmt::format("no device to test on, CAPLET_TEST_DEVICE {}: {}",
                               choice.empty() ? "is not set" : "is '" + choice + "'",
                               error.what()));
  }
}

const Device& test_device() {
  static const Device device = test_device(Encoding::automatic);
  return device;
}

int test_width() { return test_device().encoding() == Encoding::wide ? 8 : 1; }

}  // namespace caplet::test
