// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are the checks behind self_test(), with one line for each error of a device.
#pragma once

#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

/// WrongDevice is thrown if the device computes wrongly, as its self-test shows.
class WrongDevice : public RunError {
 public:
  using RunError::RunError;
};

/// Builds `source` (the text of kernels/probe/self_test.cl, or a variant of it) and compares its
/// results with the host: sums, products and fma correctly rounded; quotients within 2.5 ulp and
/// square roots within 3 ulp (OpenCL 1.2, section 7.4); NaN, infinities and comparisons; integer
/// functions; vload8, vstore8 and select; atomics; work-group ids. Denormal inputs and results are
/// not tested: devices may flush them. The result is empty when all is well. Throws RunError when
/// it does not build or run.
std::vector<std::string> self_test_failures(const Device& device, const std::string& source);

/// Returns whether a test that depends on the device, its driver and these texts must run:
/// $CAPLET_SELF_TEST is 1, or unset and remember_self_test has not been called for them. 0: never.
bool self_test_is_due(const Device& device, const std::vector<std::string>& texts);
void remember_self_test(const Device& device, const std::vector<std::string>& texts);

/// Throws WrongDevice with the device, its driver and the failures.
[[noreturn]] void refuse_device(const Device& device, const std::vector<std::string>& failures);

}  // namespace caplet
