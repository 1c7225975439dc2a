// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Rays on which device and reference once disagreed, bit by bit.
#include <gtest/gtest.h>

#include <cmath>

#include "probe.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

struct KeptCase {
  const char* name;
  FlatPrimitive primitive;
  RayRecord ray;
};
void PrintTo(const KeptCase& kept, std::ostream* out) { *out << kept.name; }

const KeptCase cases[] = {
    // Seen along the ray the patch crosses over itself: rulings of one family are short there, and
    // their roots unsure.
    {"PatchThatCrossesOver",
     make_bilinear({-0x1.99f5f4p-1f, 0x1.30ecp-3f, 0x1.29182cp-1f},
                   {-0x1.1d339ep-1f, 0x1.52d4e6p-2f, -0x1.8600c2p-1f},
                   {0x1.8308d6p-1f, -0x1.7687b2p-3f, -0x1.41d724p-1f},
                   {-0x1.897166p-1f, -0x1.12e78ap-1f, 0x1.64819ep-2f}),
     {0x1.ed10e2p+0f, -0x1.915d1ap+0f, -0x1.7cdb74p-1f, 0, -0x1.4c5c44p-3f, 0x1.c62cbap-4f,
      0x1.81aef4p-5f, INFINITY}},
};

class Kept : public testing::TestWithParam<KeptCase> {};

TEST_P(Kept, DeviceAndReferenceAgree) {
  const KeptCase& kept = GetParam();
  const auto expected = reference::crossings(reference_of(kept.primitive), reference_ray(kept.ray));
  ASSERT_FALSE(expected.empty());
  for (const int width : {1, 8}) {
    const Listed listed = Probe(test_device(), width, {kept.primitive}).list({0}, {kept.ray}, 8)[0];
    ASSERT_EQ(listed.all.size(), expected.size()) << "width " << width;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(listed.all[i].t, expected[i].t,
                  1e-4 * expected[i].t);  // grazing rays: a bound over a small cosine
      EXPECT_EQ((listed.all[i].surface & CAPLET_LEAVING) != 0, expected[i].leaving);
    }
    EXPECT_EQ(listed.nearest.t, listed.all[0].t);
    EXPECT_TRUE(listed.any);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Kept, testing::ValuesIn(cases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace caplet::test
