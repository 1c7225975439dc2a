// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The device that all tests run on: CAPLET_TEST_DEVICE (index, cpu, gpu or part of a name, as
// `--device`), else the default choice.
#pragma once

#include "device/device.h"

namespace caplet::test {

/// The device, shared by the tests of a program. The first call says on stdout which one it is.
/// Throws RunError that names CAPLET_TEST_DEVICE and lists the devices when there is none, or none
/// of that name.
const Device& test_device();

/// The same device with a context and counts of its own. `automatic`: in the encoding that
/// CAPLET_ENCODING says, else its natural one.
Device test_device(Encoding encoding);

/// CAPLET_REAL_WIDTH of the kernels that the renderer would build for test_device(): 8 or 1.
int test_width();

}  // namespace caplet::test

/// Skips the test, with the reason printed, unless the tests run on a device of PoCL.
#define CAPLET_NEEDS_POCL()                                      \
  do {                                                           \
    if (!::caplet::test::test_device().is_pocl())                \
      GTEST_SKIP() << "needs PoCL; the tests run on "            \
                   << ::caplet::test::test_device().info().name; \
  } while (false)
