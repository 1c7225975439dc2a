// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "support/device_choice.h"

#include <cstdlib>

namespace caplet::test {

std::string test_device_choice() {
  const char* choice = std::getenv("CAPLET_TEST_DEVICE");
  return choice ? choice : "";
}

}  // namespace caplet::test
