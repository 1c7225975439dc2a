// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// OpenCL and fork(2). A child has the driver's memory with the locks that other threads held, and none of the driver's threads:
// what it asks of OpenCL may wait for ever.
#pragma once

namespace caplet {

/// Comes before every use of OpenCL, and before locks that another thread may hold while it uses OpenCL. Throws RunError in a
/// process that was forked after a call of this.
void begin_opencl();

/// Whether begin_opencl throws. Nothing is given back to OpenCL then: that may wait for ever as well.
bool forked_after_opencl() noexcept;

}  // namespace caplet
