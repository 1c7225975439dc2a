// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <vector>

#include "bench/device_tracer.h"
#include "shared/records.h"

namespace caplet::test {

using bench::DeviceTracer;

/// Asks both, of one scene, for the nearest and for any hit of the rays, and fails where they do
/// not answer alike to the bit. The hits.
std::vector<HitRecord> same_hits(DeviceTracer& seen_by, DeviceTracer& expected_of,
                                 const std::vector<RayRecord>& rays);

}  // namespace caplet::test
