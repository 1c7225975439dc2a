// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "film/image.h"

namespace caplet::test {

/// Expects the same channels with the same bits in two EXR files.
inline void expect_equal_pictures(const std::filesystem::path& a, const std::filesystem::path& b) {
  const LayeredImage one = read_exr(a), other = read_exr(b);
  ASSERT_EQ(one.channels.size(), other.channels.size());
  for (const Channel& channel : one.channels) {
    ASSERT_NE(other.find(channel.name), nullptr) << channel.name;
    EXPECT_EQ(channel.floats, other.find(channel.name)->floats) << channel.name;
    EXPECT_EQ(channel.uints, other.find(channel.name)->uints) << channel.name;
  }
}

}  // namespace caplet::test
