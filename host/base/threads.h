// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// On how many threads the host and CPU devices compute.
#pragma once

namespace caplet {

/// Limits usable_threads() and PoCL's CPU device from now on. Call it before the first OpenCL call
/// of the process; `most` is at least 1.
void limit_threads(unsigned most);

/// Returns the number of processors, at least 1, or the limit if it is less.
unsigned usable_threads();

/// Returns the limit; 0: there is none.
unsigned thread_limit();

}  // namespace caplet
