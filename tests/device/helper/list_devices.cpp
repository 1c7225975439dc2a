// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Prints the number of devices, then what choosing one says. For choose_test.cpp, which runs it
// without a platform.
#include <iostream>

#include "device/device.h"

int main() {
  std::cout << caplet::list_devices().size() << " devices\n";
  try {
    std::cout << caplet::Device::choose("").info().name << "\n";
  } catch (const caplet::RunError& error) {
    std::cout << error.what() << "\n";
  }
}
