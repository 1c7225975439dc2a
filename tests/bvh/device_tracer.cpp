// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "support/test_device.h"

namespace caplet::test {

namespace {

/// Drivers but PoCL may round the same source otherwise in two kernels: each parameter is then off
/// by its bound, 16 eps of the origin's distance and of the way (trace/trace.cl).
bool is_same(const HitRecord& seen, const HitRecord& expected, const RayRecord& ray) {
  if (std::memcmp(&seen, &expected, sizeof seen) == 0) return true;
  if (test_device().is_pocl() || seen.slot != expected.slot || seen.instance != expected.instance)
    return false;
  const double way = std::hypot(ray.dx, ray.dy, ray.dz),
               reach = std::hypot(ray.ox, ray.oy, ray.oz) + expected.t * way;
  return std::abs(double{seen.t} - double{expected.t}) * way <= 2 * 16 * 0x1p-24 * reach;
}

}  // namespace

std::vector<HitRecord> same_hits(DeviceTracer& seen_by, DeviceTracer& expected_of,
                                 const std::vector<RayRecord>& rays) {
  const auto expected = expected_of.closest(rays), seen = seen_by.closest(rays);
  int different = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!is_same(seen[i], expected[i], rays[i]) && different++ < 5)
      ADD_FAILURE() << "ray " << i << ": t " << seen[i].t << " of slot " << seen[i].slot
                    << " in place of " << expected[i].t << " of " << expected[i].slot;
  EXPECT_EQ(different, 0);
  EXPECT_EQ(seen_by.any(rays), expected_of.any(rays));
  return seen;
}

}  // namespace caplet::test
