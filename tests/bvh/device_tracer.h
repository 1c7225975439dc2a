// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "bench/device_tracer.h"

namespace caplet::test {

using bench::DeviceTracer;

}  // namespace caplet::test
