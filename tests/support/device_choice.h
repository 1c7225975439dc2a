// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which device tests run on, for those that know no OpenCL themselves: they run the built program.
#pragma once

#include <string>

namespace caplet::test {

/// What CAPLET_TEST_DEVICE says, as `--device` takes it; empty, the default choice, when it is not
/// set.
std::string test_device_choice();

}  // namespace caplet::test
