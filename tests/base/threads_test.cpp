// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The limit of threads.
#include "base/threads.h"

#include <gtest/gtest.h>

#include <thread>

namespace caplet {
namespace {

TEST(Threads, AreThoseOfProcessorsOrFewer) {
  const unsigned all = std::thread::hardware_concurrency();
  EXPECT_EQ(thread_limit(), 0U);
  EXPECT_EQ(usable_threads(), all);
  limit_threads(1);
  EXPECT_EQ(usable_threads(), 1U);
  EXPECT_EQ(thread_limit(), 1U);
  limit_threads(all + 1);
  EXPECT_EQ(usable_threads(), all);
}

}  // namespace
}  // namespace caplet
