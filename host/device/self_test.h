// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The checks behind self_test(), one line for each thing that a device gets wrong.
#pragma once

#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

/// Builds `source` (the text of kernels/probe/self_test.cl, or a variant of it) and compares what it computes with the host:
/// sums, products and fma correctly rounded; quotients within 2.5 ulp and square roots within 3 ulp (OpenCL 1.2, section 7.4);
/// NaN, infinities and comparisons; integer functions; vload8, vstore8 and select; atomics; work-group ids. Denormal inputs and
/// results are not tested: devices may flush them. Empty when all is well. Throws RunError when it does not build or run.
std::vector<std::string> self_test_failures(const Device& device, const std::string& source);

}  // namespace caplet
