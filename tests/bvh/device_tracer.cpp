// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device_tracer.h"

#include <gtest/gtest.h>

#include <cstring>

namespace caplet::test {

std::vector<HitRecord> same_hits(DeviceTracer& seen_by, DeviceTracer& expected_of,
                                 const std::vector<RayRecord>& rays) {
  const auto expected = expected_of.closest(rays), seen = seen_by.closest(rays);
  int different = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (std::memcmp(&seen[i], &expected[i], sizeof seen[i]) != 0 && different++ < 5)
      ADD_FAILURE() << "ray " << i << ": t " << seen[i].t << " of slot " << seen[i].slot
                    << " in place of " << expected[i].t << " of " << expected[i].slot;
  EXPECT_EQ(different, 0);
  EXPECT_EQ(seen_by.any(rays), expected_of.any(rays));
  return seen;
}

}  // namespace caplet::test
