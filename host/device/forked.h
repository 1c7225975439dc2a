// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file handles OpenCL and fork(2). A child has the driver's memory with the locks that other
// threads held, and none of the driver's threads: an OpenCL call may wait for ever.
#pragma once

namespace caplet {

/// Call this before every use of OpenCL, and before locks that another thread may hold while it
/// uses OpenCL. Throws RunError in a process that was forked after a call of this.
void begin_opencl();

/// Returns whether begin_opencl throws. Nothing is released to OpenCL then: that may wait for ever
/// as well.
bool forked_after_opencl() noexcept;

}  // namespace caplet
