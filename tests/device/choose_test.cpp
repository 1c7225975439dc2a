// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Choosing among the devices that are there, and where there is none: of all of them, so not of the
// one that the other tests run on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "device/device.h"
#include "support/data.h"
#include "support/environment.h"

namespace caplet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Choose, EveryListedDeviceOpensByItsIndex) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (const DeviceInfo& info : devices) {
    const Device device = Device::choose(std::to_string(info.index));
    EXPECT_EQ(device.info().name, info.name);
    EXPECT_EQ(device.info().index, info.index);
    EXPECT_GT(info.compute_units, 0u);
    EXPECT_GT(info.global_bytes, 0u);
    EXPECT_GE(info.global_bytes, info.max_allocation_bytes);
    EXPECT_EQ(device.is_cpu(), info.type == "cpu");
  }
  EXPECT_THROW(Device::choose(std::to_string(devices.size())), InputError);
}

TEST(Encodings, WideIsForCpusThatComputeWithVectors) {
  DeviceInfo info;
  info.type = "cpu";
  for (const unsigned width : {4u, 8u, 16u}) {
    info.native_float_width = width;
    EXPECT_EQ(natural_encoding(info), Encoding::wide) << width;
  }
  info.native_float_width = 1;  // llvmpipe: each work-item is a lane
  EXPECT_EQ(natural_encoding(info), Encoding::single);
  info.type = "gpu";
  info.native_float_width = 8;
  EXPECT_EQ(natural_encoding(info), Encoding::single);
}

TEST(Encodings, AreForcedByArgumentThenByTheEnvironment) {
  const test::ScopedVariable none("CAPLET_ENCODING", std::nullopt);
  const Device plain = Device::choose("");
  EXPECT_EQ(plain.encoding(), natural_encoding(plain.info()));
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    EXPECT_EQ(Device::choose("", encoding).encoding(), encoding);
    const test::ScopedVariable variable("CAPLET_ENCODING", name_of(encoding));
    EXPECT_EQ(Device::choose("").encoding(), encoding);
    EXPECT_EQ(Device::choose("", Encoding::single).encoding(), Encoding::single);
  }
  const test::ScopedVariable wrong("CAPLET_ENCODING", "narrow");
  EXPECT_THROW(Device::choose(""), InputError);
}

TEST(Choose, WithoutAPlatformThereAreNoDevices) {
  const std::filesystem::path empty = test::temporary_folder();
  const std::string command = "OCL_ICD_VENDORS='" + empty.string() + "' '" CAPLET_LIST_DEVICES "'";
  FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::array<char, 4096> text{};
  const std::size_t length = std::fread(text.data(), 1, text.size(), pipe);
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_THAT(std::string(text.data(), length),
              AllOf(HasSubstr("0 devices\n"), HasSubstr("pocl-opencl-icd")));
}

}  // namespace
}  // namespace caplet
