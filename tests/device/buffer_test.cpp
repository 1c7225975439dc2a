// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Buffers: round trips, accounting, limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>
#include <numeric>

#include "device/device.h"
#include "support/environment.h"
#include "support/test_device.h"

namespace caplet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class BufferTest : public testing::Test {
 protected:
  Device device_ = test::test_device(Encoding::automatic);

  std::string refusal(std::size_t bytes) {
    try {
      const RawBuffer buffer(device_, bytes, false, nullptr);
    } catch (const RunError& error) {
      return error.what();
    }
    return "accepted";
  }
};

TEST_F(BufferTest, GivesBackWhatItWasMadeFrom) {
  std::vector<float> values(1000);
  std::iota(values.begin(), values.end(), -3.0f);
  const Buffer<float> buffer(device_, std::span<const float>(values));
  EXPECT_EQ(buffer.size(), 1000u);
  EXPECT_EQ(buffer.read(), values);
}

TEST_F(BufferTest, GivesBackWhatWasWritten) {
  Buffer<cl_uint> buffer(device_, 6);
  buffer.write(std::vector<cl_uint>{1, 2, 3, 4, 5, 6});
  const cl_uint changed[] = {30, 40};
  static_cast<RawBuffer&>(buffer).write(changed, 8, 8);
  EXPECT_EQ(buffer.read(), (std::vector<cl_uint>{1, 2, 30, 40, 5, 6}));
  cl_uint one = 0;
  static_cast<const RawBuffer&>(buffer).read(&one, 16, 4);
  EXPECT_EQ(one, 5u);
}

// Those of processors are in huge pages from 2 MiB on.
TEST_F(BufferTest, LargeOnesKeepWhatTheyAreGiven) {
  std::vector<cl_uint> values((std::size_t{20} << 18) + 3);
  std::iota(values.begin(), values.end(), 7u);
  for (const char* const huge : {"1", "0"}) {
    const test::ScopedVariable variable("CAPLET_HUGE_PAGES", huge);
    Buffer<cl_uint> buffer(device_, std::span<const cl_uint>(values));
    EXPECT_EQ(buffer.read(), values) << huge;
    const cl_uint changed[] = {1, 2};
    static_cast<RawBuffer&>(buffer).write(changed, buffer.size() * 4 - 8, 8);
    const std::vector<cl_uint> read = buffer.read();
    EXPECT_EQ(read[read.size() - 3], values[values.size() - 3]);
    EXPECT_EQ(read[read.size() - 2], 1u);
    EXPECT_EQ(read.back(), 2u);
    buffer.clear();
    EXPECT_EQ(buffer.read(), std::vector<cl_uint>(values.size(), 0u));
  }
}

TEST_F(BufferTest, LargeOnesAreGivenBack) {
  const auto pages = [] {  // of addresses in use
    std::size_t count = 0;
    std::ifstream("/proc/self/statm") >> count;
    return count;
  };
  if (pages() == 0) GTEST_SKIP() << "no /proc/self/statm";
  const auto use = [&] {
    Buffer<cl_uchar>(device_, std::size_t{64} << 20).clear();
    device_.finish();
  };
  use();
  const std::size_t before = pages();
  for (int i = 0; i < 20; ++i) use();
  EXPECT_LT(pages(), before + (std::size_t{256} << 20) / 4096);
}

TEST_F(BufferTest, MayBeEmpty) {
  Buffer<float> none(device_, 0);
  EXPECT_EQ(none.size(), 0u);
  EXPECT_EQ(none.read(), std::vector<float>());
  none.write({});
  EXPECT_NE(none.handle()(), nullptr);
  EXPECT_EQ(Buffer<float>(device_, std::span<const float>()).size(), 0u);
}

TEST_F(BufferTest, RefusesPlacesOutsideIt) {
  Buffer<float> buffer(device_, 4);
  float values[8] = {};
  EXPECT_THROW(buffer.write(std::span<const float>(values, 8)), std::logic_error);
  EXPECT_THROW(static_cast<RawBuffer&>(buffer).read(values, 12, 8), std::logic_error);
  EXPECT_THROW(static_cast<RawBuffer&>(buffer).read(values, std::size_t{0} - 4, 8),
               std::logic_error);
}

TEST_F(BufferTest, BytesAreCounted) {
  EXPECT_EQ(device_.bytes_allocated(), 0u);
  {
    const Buffer<float> first(device_, 1000);
    Buffer<float> second(device_, 500);
    EXPECT_EQ(device_.bytes_allocated(), 6000u);
    const Device copy = device_;
    second = Buffer<float>(copy, 100);
    EXPECT_EQ(device_.bytes_allocated(), 4400u);
    const Buffer<float> shared = first;
    EXPECT_EQ(device_.bytes_allocated(), 4400u);
  }
  EXPECT_EQ(device_.bytes_allocated(), 0u);
  EXPECT_EQ(device_.bytes_peak(), 6400u);
}

TEST_F(BufferTest, TooLargeANeedNamesBothNumbers) {
  const std::uint64_t limit = device_.info().max_allocation_bytes;
  EXPECT_THAT(
      refusal(limit + 1),
      AllOf(HasSubstr(fmt::format("needs {} bytes, the device allows {} bytes", limit + 1, limit)),
            HasSubstr(device_.info().name)));
  EXPECT_EQ(device_.bytes_allocated(), 0u);
}

TEST_F(BufferTest, AllBuffersTogetherMustFit) {
  const std::uint64_t global = device_.info().global_bytes;
  std::vector<RawBuffer> buffers;
  const std::uint64_t part = std::min(device_.info().max_allocation_bytes, global / 4);
  std::string message;
  try {
    for (int i = 0; i < 8; ++i) buffers.emplace_back(device_, part, false, nullptr);
  } catch (const RunError& error) {
    message = error.what();
  }
  EXPECT_THAT(message, HasSubstr(fmt::format("needs {} bytes", part)));
}

}  // namespace
}  // namespace caplet
