// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Threads that fail or hang, without devices.
#include "render/detail/crew.h"

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

std::shared_ptr<Crew> crew_of(std::size_t members, const std::shared_ptr<Seen>& seen) {
  return std::make_shared<Crew>(members, Crew::Calls{[seen](std::size_t member) { return member == 0 ? seen->beats.load() : 0; },
                                                     [seen](std::size_t member, std::exception_ptr failure) {
                                                       (failure ? seen->failed : seen->hung).push_back(static_cast<int>(member));
                                                     }});
}

TEST(Crew, FailuresAreToldOfAndTheOthersGoOn) {
  const auto seen = std::make_shared<Seen>();
  const auto crew = crew_of(3, seen);
  crew->run(60, [seen, crew](std::size_t i, Crew::Lock& lock) {
    if (crew->attempt(i, lock, [i] {
          if (i == 1) throw std::runtime_error("no");
        }))
      seen->done.push_back(static_cast<int>(i));
  });
  EXPECT_EQ(seen->failed, std::vector{1});
  EXPECT_TRUE(seen->hung.empty());
  EXPECT_EQ(seen->done.size(), 2u);
  EXPECT_FALSE(Crew::any_given_up());
}

TEST(Crew, OneAloneWorksOnTheCallersThread) {
  const auto seen = std::make_shared<Seen>();
  const auto crew = crew_of(1, seen);
  std::thread::id on;
  crew->run(60, [&](std::size_t, Crew::Lock&) { on = std::this_thread::get_id(); });
  EXPECT_EQ(on, std::this_thread::get_id());
}

// One that hangs is given up; the other, which then is silent for as long, is the last, and is waited for.
TEST(Crew, WhoHangsIsGivenUpButNotTheLast) {
  const auto seen = std::make_shared<Seen>();
  const auto crew = crew_of(2, seen);
  const auto start = std::chrono::steady_clock::now();
  crew->run(0.3, [seen, crew](std::size_t i, Crew::Lock& lock) {
    const bool there = crew->attempt(i, lock, [seen, i] {
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
    const std::lock_guard lock(crew->mutex());
    EXPECT_EQ(seen->done, std::vector{0});
    EXPECT_EQ(seen->hung, std::vector{1});
  }
  EXPECT_TRUE(Crew::any_given_up());
  seen->release.set_value();
  for (int i = 0; i < 200 && Crew::any_given_up(); ++i) std::this_thread::sleep_for(milliseconds(20));
  EXPECT_FALSE(Crew::any_given_up());
  const std::lock_guard lock(crew->mutex());
  EXPECT_EQ(seen->done.size(), 1u);  // who comes back finds itself gone
}

TEST(Crew, WhoAnswersIsNotGivenUp) {
  const auto seen = std::make_shared<Seen>();
  const auto crew = crew_of(2, seen);
  crew->run(0.4, [seen, crew](std::size_t i, Crew::Lock& lock) {
    std::ignore = crew->attempt(i, lock, [&] {
      for (int k = 0; i == 0 && k < 12; ++k) {
        std::this_thread::sleep_for(milliseconds(100));
        ++seen->beats;
      }
    });
    // Who waits for the others is not silent either.
    if (i == 1) crew->wait(lock);
    crew->notify();
  });
  EXPECT_TRUE(seen->hung.empty());
}

}  // namespace
}  // namespace caplet::test
