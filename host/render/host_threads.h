// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// Limits the threads of TBB, of the host and of PoCL's CPU device for the rest of the process, as
/// limit_threads does; `most` is at least 1. Only the first call counts for TBB.
void limit_host_threads(unsigned most);

}  // namespace caplet
