// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which of some devices a choice means, and what is said when it means none.
#include "device/select.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace caplet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<DeviceInfo> some_devices() {
  std::vector<DeviceInfo> out(4);
  const char* names[] = {"pthread-EPYC", "Tesla A", "Tesla B", "Odd"};
  const char* types[] = {"cpu", "gpu", "gpu", "accelerator"};
  for (int i = 0; i < 4; ++i) {
    out[static_cast<std::size_t>(i)].index = i;
    out[static_cast<std::size_t>(i)].name = names[i];
    out[static_cast<std::size_t>(i)].type = types[i];
  }
  return out;
}

std::string refusal(const std::vector<DeviceInfo>& devices, const std::string& choice) {
  try {
    select_device(devices, choice);
  } catch (const InputError& error) {
    return error.what();
  } catch (const RunError& error) {
    return std::string("failed: ") + error.what();
  }
  return "accepted";
}

TEST(Select, TakesAGpuFirst) {
  EXPECT_EQ(select_device(some_devices(), ""), 1u);
  const std::vector<DeviceInfo> no_gpu = {some_devices()[3], some_devices()[0]};
  EXPECT_EQ(select_device(no_gpu, ""), 0u);
}

TEST(Select, TakesAnIndexATypeOrPartOfAName) {
  EXPECT_EQ(select_device(some_devices(), "3"), 3u);
  EXPECT_EQ(select_device(some_devices(), "cpu"), 0u);
  EXPECT_EQ(select_device(some_devices(), "GPU"), 1u);
  EXPECT_EQ(select_device(some_devices(), "epyc"), 0u);
  EXPECT_EQ(select_device(some_devices(), "SLA b"), 2u);
}

TEST(Select, AFullNameIsNotAmbiguous) {
  std::vector<DeviceInfo> devices = some_devices();
  devices[2].name = "Tesla A100";
  EXPECT_EQ(select_device(devices, "tesla a"), 1u);
}

TEST(Select, RefusalsListTheDevices) {
  const auto list =
      HasSubstr("0 'pthread-EPYC' (cpu), 1 'Tesla A' (gpu), 2 'Tesla B' (gpu), 3 'Odd'");
  EXPECT_THAT(refusal(some_devices(), "4"), AllOf(list, HasSubstr("no device has the index 4")));
  EXPECT_THAT(refusal(some_devices(), "99999999999999999999"),
              AllOf(list, HasSubstr("no device has the index")));
  EXPECT_THAT(refusal(some_devices(), "radeon"),
              AllOf(list, HasSubstr("no device has 'radeon' in its name")));
  EXPECT_THAT(refusal(some_devices(), "tesla"),
              AllOf(list, HasSubstr("more than one device has 'tesla' in its name")));
  EXPECT_THAT(refusal({some_devices()[3]}, "gpu"), HasSubstr("no device of type 'gpu'"));
  EXPECT_THAT(refusal(some_devices(), "-1"), HasSubstr("no device has '-1' in its name"));
}

TEST(Select, SeveralAreAListOrAll) {
  using testing::ElementsAre;
  EXPECT_THAT(select_devices(some_devices(), "all"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(select_devices(some_devices(), "2,0"), ElementsAre(2, 0));
  EXPECT_THAT(select_devices(some_devices(), "gpu,cpu,odd"), ElementsAre(1, 0, 3));
  EXPECT_THAT(select_devices(some_devices(), "1"), ElementsAre(1));
  EXPECT_THAT(select_devices(some_devices(), ""), ElementsAre(1));
  std::vector<DeviceInfo> devices = some_devices();
  devices[3].name = "Odd, but even";
  EXPECT_THAT(select_devices(devices, "odd, but"), ElementsAre(3));
  const auto refused = [](const std::string& choice) {
    try {
      select_devices(some_devices(), choice);
    } catch (const UnknownDevice& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_THAT(refused("0,1,0"),
              HasSubstr("device 0 is named twice in '0,1,0'; the devices are 0 'pthread-EPYC'"));
  EXPECT_THAT(refused("0,cpu"), HasSubstr("device 0 is named twice"));
  EXPECT_THAT(refused("0,"), HasSubstr("'0,' is no list of devices"));
  EXPECT_THAT(refused("0,4"), HasSubstr("no device has the index 4"));
  EXPECT_THROW(select_devices({}, "all"), NoDevice);
}

TEST(Select, NothingToChooseFromNamesThePackage) {
  EXPECT_THAT(refusal({}, ""),
              AllOf(HasSubstr("failed: no OpenCL device"), HasSubstr("pocl-opencl-icd")));
  EXPECT_THAT(refusal({}, "0"), HasSubstr("pocl-opencl-icd"));
}

}  // namespace
}  // namespace caplet
