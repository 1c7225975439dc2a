// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Threads that work with a device each, of which some may fail or hang.
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

/// A thread that hangs in a driver cannot be ended. It is given up: nobody waits for it, and when it comes back after all it
/// finds itself gone and ends. So all that the threads touch is held by the functions below, which such a thread keeps alive, and
/// what they change together is changed under the mutex.
class Crew : public std::enable_shared_from_this<Crew> {
 public:
  using Lock = std::unique_lock<std::mutex>;
  struct Calls {
    /// A number that changes whenever the member's device has answered. From any thread.
    std::function<std::uint64_t(std::size_t member)> beats;
    /// The member has failed (with what it threw) or hung (null), and is gone. Under the mutex.
    std::function<void(std::size_t member, std::exception_ptr failure)> lost;
  };
  Crew(std::size_t members, Calls calls) : calls_(std::move(calls)), members_(members) {}

  /// Calls `work(member, lock)` for each member, on a thread each, under the mutex; a member alone works on the caller's thread.
  /// Returns when all have returned or are gone. A member that is in attempt() and whose device does not answer for `patience`
  /// seconds is given up where there are others.
  void run(double patience, const std::function<void(std::size_t member, Lock& lock)>& work);

  /// For a member's work with its device: does it without the lock, and catches what it throws. False: the member is gone.
  bool attempt(std::size_t member, Lock& lock, const std::function<void()>& work);
  /// Waits for another member to change something.
  void wait(Lock& lock) { changed_.wait(lock); }
  void notify() { changed_.notify_all(); }
  /// Under the mutex.
  bool gone(std::size_t member) const { return members_[member].gone; }
  std::mutex& mutex() { return mutex_; }

  /// Whether a thread has been given up in this process and not come back: at an ordinary exit it would wake up in what is no
  /// longer there.
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
