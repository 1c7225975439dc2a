// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Threads that fail or hang, without devices.
#include "render/detail/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>
#include <tuple>

namespace caplet::test {
namespace {

using std::chrono::milliseconds;

/// What happened, which threads that hang keep alive.
struct Seen {
  std::vector<int> failed, hung, done;
  std::atomic<std::uint64_t> beats{0};
  std::promise<void> release;
  std::shared_future<void> released = release.get_future().share();
};

std::shared_ptr<WorkerPool> pool_of(std::size_t members, const std::shared_ptr<Seen>& seen) {
  return std::make_shared<WorkerPool>(
      members,
      WorkerPool::Calls{[seen](std::size_t member) { return member == 0 ? seen->beats.load() : 0; },
                        [seen](std::size_t member, std::exception_ptr failure) {
                          (failure ? seen->failed : seen->hung).push_back(static_cast<int>(member));
                        }});
}

TEST(WorkerPool, FailuresAreToldOfAndTheOthersGoOn) {
  const auto seen = std::make_shared<Seen>();
  const auto pool = pool_of(3, seen);
  pool->run(60, [seen, pool](std::size_t i, WorkerPool::Lock& lock) {
    if (pool->attempt(i, lock, [i] {
          if (i == 1) throw std::runtime_error("no");
        }))
      seen->done.push_back(static_cast<int>(i));
  });
  EXPECT_EQ(seen->failed, std::vector{1});
  EXPECT_TRUE(seen->hung.empty());
  EXPECT_EQ(seen->done.size(), 2u);
  EXPECT_FALSE(WorkerPool::any_given_up());
}

TEST(WorkerPool, OneAloneWorksOnTheCallersThread) {
  const auto seen = std::make_shared<Seen>();
  const auto pool = pool_of(1, seen);
  std::thread::id on;
  pool->run(60, [&](std::size_t, WorkerPool::Lock&) { on = std::this_thread::get_id(); });
  EXPECT_EQ(on, std::this_thread::get_id());
}

// One that hangs is given up; the other, which then is silent for as long, is the last, and is
// waited for.
TEST(WorkerPool, WhoHangsIsGivenUpButNotTheLast) {
  const auto seen = std::make_shared<Seen>();
  const auto pool = pool_of(2, seen);
  const auto start = std::chrono::steady_clock::now();
  pool->run(0.3, [seen, pool](std::size_t i, WorkerPool::Lock& lock) {
    const bool there = pool->attempt(i, lock, [seen, i] {
      if (i == 1) return seen->released.wait();
      for (int k = 0; k < 8; ++k) {
        std::this_thread::sleep_for(milliseconds(100));
        ++seen->beats;
      }
      std::this_thread::sleep_for(milliseconds(600));
    });
    if (there) seen->done.push_back(static_cast<int>(i));
  });
  EXPECT_GT(std::chrono::steady_clock::now() - start, milliseconds(300));
  {
    const std::lock_guard lock(pool->mutex());
    EXPECT_EQ(seen->done, std::vector{0});
    EXPECT_EQ(seen->hung, std::vector{1});
  }
  EXPECT_TRUE(WorkerPool::any_given_up());
  seen->release.set_value();
  for (int i = 0; i < 200 && WorkerPool::any_given_up(); ++i)
    std::this_thread::sleep_for(milliseconds(20));
  EXPECT_FALSE(WorkerPool::any_given_up());
  const std::lock_guard lock(pool->mutex());
  EXPECT_EQ(seen->done.size(), 1u);  // who comes back finds itself gone
}

TEST(WorkerPool, WhoAnswersIsNotGivenUp) {
  const auto seen = std::make_shared<Seen>();
  const auto pool = pool_of(2, seen);
  pool->run(0.4, [seen, pool](std::size_t i, WorkerPool::Lock& lock) {
    std::ignore = pool->attempt(i, lock, [&] {
      for (int k = 0; i == 0 && k < 12; ++k) {
        std::this_thread::sleep_for(milliseconds(100));
        ++seen->beats;
      }
    });
    // Who waits for the others is not silent either.
    if (i == 1) pool->wait(lock);
    pool->notify();
  });
  EXPECT_TRUE(seen->hung.empty());
}

}  // namespace
}  // namespace caplet::test
