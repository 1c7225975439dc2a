// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are threads that work with a device each; some may fail or hang.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace caplet {

/// A thread that hangs in a driver cannot be ended, so it is abandoned: nobody waits for it, and if
/// it returns after all it finds that it is gone and ends. So the functions below hold everything
/// that the threads use, and such a thread keeps it alive; what they change together is changed
/// under the mutex.
class WorkerPool : public std::enable_shared_from_this<WorkerPool> {
 public:
  using Lock = std::unique_lock<std::mutex>;
  struct Calls {
    /// Returns a number that changes whenever the member's device has answered. It is called from
    /// any thread.
    std::function<std::uint64_t(std::size_t member)> beats;
    /// This is called, under the mutex, when the member has failed (with what it threw) or hung
    /// (null), and is gone.
    std::function<void(std::size_t member, std::exception_ptr failure)> lost;
  };
  WorkerPool(std::size_t members, Calls calls) : calls_(std::move(calls)), members_(members) {}

  /// Calls `work(member, lock)` for each member, on a thread each, under the mutex; a single member
  /// works on the caller's thread. Returns when all have returned or are gone. A member in
  /// attempt() whose device does not answer for `patience` seconds is abandoned if there are
  /// others.
  void run(double patience, const std::function<void(std::size_t member, Lock& lock)>& work);

  /// Does a member's work with its device without the lock, and catches what it throws. Returns
  /// false if the member is gone.
  bool attempt(std::size_t member, Lock& lock, const std::function<void()>& work);
  /// Waits for another member to change something.
  void wait(Lock& lock) { changed_.wait(lock); }
  void notify() { changed_.notify_all(); }
  /// Call this under the mutex.
  bool gone(std::size_t member) const { return members_[member].gone; }
  std::mutex& mutex() { return mutex_; }

  /// Returns whether a thread was abandoned in this process and has not come back: at an ordinary
  /// exit it would use objects that no longer exist.
  static bool any_given_up();

 private:
  struct Member {
    bool busy = false, gone = false, given_up = false, ended = false;
    std::uint64_t beats = 0;
    double silent = 0;  // seconds since they changed
  };
  void lose(std::size_t member, std::exception_ptr failure);
  std::size_t members_there() const;

  Calls calls_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Member> members_;
};

}  // namespace caplet
