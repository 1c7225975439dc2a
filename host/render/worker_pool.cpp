// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/detail/worker_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

namespace caplet {

namespace {

constexpr double tick_seconds = 0.05;

std::atomic<int>& given_up() {
  static std::atomic<int> count{0};
  return count;
}

}  // namespace

bool WorkerPool::any_given_up() { return given_up() > 0; }

std::size_t WorkerPool::members_there() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(members_, [](const Member& member) { return !member.gone; }));
}

void WorkerPool::lose(std::size_t member, std::exception_ptr failure) {
  members_[member].gone = true;
  calls_.lost(member, std::move(failure));
  notify();
}

bool WorkerPool::attempt(std::size_t member, Lock& lock, const std::function<void()>& work) {
  Member& self = members_[member];
  self.busy = true;
  self.silent = 0;
  lock.unlock();
  std::exception_ptr failure;
  try {
    work();
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  self.busy = false;
  if (self.gone) return false;
  if (failure) lose(member, failure);
  return !failure;
}

void WorkerPool::run(double patience, const std::function<void(std::size_t, Lock&)>& work) {
  if (members_.size() == 1) {
    Lock lock(mutex_);
    work(0, lock);
    return;
  }
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < members_.size(); ++i)
    threads.emplace_back([self = shared_from_this(), work, i] {
      Lock lock(self->mutex_);
      work(i, lock);
      if (self->members_[i].given_up) --given_up();
      self->members_[i].ended = true;
      self->notify();
    });
  std::vector<bool> hangs;
  {
    Lock lock(mutex_);
    const auto finished = [&] {
      return std::ranges::all_of(
          members_, [](const Member& member) { return member.ended || member.given_up; });
    };
    auto before = std::chrono::steady_clock::now();
    while (!finished()) {
      changed_.wait_for(lock, std::chrono::duration<double>(tick_seconds));
      const auto now = std::chrono::steady_clock::now();
      // Time in which this process was stopped does not count as silence of a device.
      const double passed =
          std::min(std::chrono::duration<double>(now - before).count(), 2 * tick_seconds);
      before = now;
      for (std::size_t i = 0; i < members_.size(); ++i) {
        Member& member = members_[i];
        if (!member.busy || member.gone) continue;
        const std::uint64_t beats = calls_.beats(i);
        member.silent = beats == member.beats ? member.silent + passed : 0;
        member.beats = beats;
        if (member.silent < patience || members_there() < 2) continue;
        member.given_up = true;
        ++given_up();
        lose(i, nullptr);
      }
    }
    for (const Member& member : members_) hangs.push_back(member.given_up);
  }
  for (std::size_t i = 0; i < threads.size(); ++i)
    hangs[i] ? threads[i].detach() : threads[i].join();
}

}  // namespace caplet
