// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The records lie in device memory as they do in the host's.
#include "device/detail/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shared/records.h"
#include "support/test_device.h"

namespace caplet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const RecordLayout& record(const std::vector<RecordLayout>& layouts, const std::string& name) {
  for (const RecordLayout& layout : layouts)
    if (layout.name == name) return layout;
  throw std::logic_error("no record " + name);
}

TEST(Layout, DeviceAgreesWithHost) { EXPECT_THAT(compare_layout(test::test_device()), IsEmpty()); }

TEST(Layout, HostSideListsEveryByte) {
  const std::vector<RecordLayout> layouts = host_layout();
  EXPECT_EQ(record(layouts, "RayRecord").bytes, sizeof(RayRecord));
  EXPECT_EQ(record(layouts, "RayRecord").fields.at(7).offset, 28u);
  EXPECT_EQ(record(layouts, "CameraRecord").fields.at(0).bytes, 48u);
  // Padding is named, so that the fields of a record follow each other without a gap.
  for (const RecordLayout& layout : layouts) {
    std::uint32_t end = 0;
    for (const FieldLayout& field : layout.fields) {
      EXPECT_EQ(field.offset, end) << layout.name << "." << field.name;
      end = field.offset + field.bytes;
    }
    EXPECT_EQ(end, layout.bytes) << layout.name;
  }
}

TEST(Layout, ReportsAShiftedField) {
  std::vector<RecordLayout> shifted = host_layout();
  for (RecordLayout& layout : shifted)
    if (layout.name == "HitRecord") layout.fields.at(1).offset += 4;
  EXPECT_THAT(
      compare_layout(test::test_device(), shifted),
      ElementsAre("HitRecord.slot: offset is 4 on the device, 8 on the host",
                  "HitRecord.slot: offset it is loaded from is 4 on the device, 8 on the host"));
}

TEST(Layout, ReportsFieldsThatChangedPlaces) {
  std::vector<RecordLayout> swapped = host_layout();
  for (RecordLayout& layout : swapped)
    if (layout.name == "RayRecord") std::swap(layout.fields.at(6).name, layout.fields.at(7).name);
  EXPECT_THAT(compare_layout(test::test_device(), swapped),
              ElementsAre("the device has RayRecord.dz where the host has RayRecord.t_max"));
}

TEST(Layout, ReportsADifferentSize) {
  std::vector<RecordLayout> larger = host_layout();
  larger.back().bytes += 16;
  EXPECT_THAT(compare_layout(test::test_device(), larger),
              ElementsAre("PickRecord: size is 64 on the device, 80 on the host"));
}

TEST(Layout, ReportsAListOfAnotherLength) {
  std::vector<RecordLayout> shorter = host_layout();
  shorter.back().fields.pop_back();
  const std::vector<std::string> mismatches = compare_layout(test::test_device(), shorter);
  ASSERT_EQ(mismatches.size(), 1u);
  EXPECT_THAT(mismatches[0], testing::HasSubstr("sizes and offsets"));
}

}  // namespace
}  // namespace caplet
