// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/host_threads.h"

#include <tbb/global_control.h>

#include "base/threads.h"

namespace caplet {

void limit_host_threads(unsigned most) {
  limit_threads(most);
  static const tbb::global_control control(tbb::global_control::max_allowed_parallelism, most);
}

}  // namespace caplet
