// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The checks behind self_test(), one line for each thing that a device gets wrong.
#pragma once

#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

/// The device computes wrongly, as its self-test says.
class WrongDevice : public RunError {
 public:
  using RunError::RunError;
};

/// Builds `source` (the text of kernels/probe/self_test.cl, or a variant of it) and compares what it computes with the host:
/// sums, products and fma correctly rounded; quotients within 2.5 ulp and square roots within 3 ulp (OpenCL 1.2, section 7.4);
/// NaN, infinities and comparisons; integer functions; vload8, vstore8 and select; atomics; work-group ids. Denormal inputs and
/// results are not tested: devices may flush them. Empty when all is well. Throws RunError when it does not build or run.
std::vector<std::string> self_test_failures(const Device& device, const std::string& source);

/// Whether a test that depends on the device, its driver and these texts is to be made: $CAPLET_SELF_TEST is 1, or unset and
/// remember_self_test has not been called for them. 0: never.
bool self_test_is_due(const Device& device, const std::vector<std::string>& texts);
void remember_self_test(const Device& device, const std::vector<std::string>& texts);

/// Throws WrongDevice that names the device, its driver and what is wrong.
[[noreturn]] void refuse_device(const Device& device, const std::vector<std::string>& failures);

}  // namespace caplet
