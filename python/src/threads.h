// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Work without the interpreter's lock, in threads that signals, the interpreter's end and fork(2)
// may come upon.
#pragma once

#include <caplet/error.h>
#include <cxxabi.h>
#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace caplet_python {

namespace nb = nanobind;

/// The end of the interpreter waits for work that is under way (docs/python.md). Has Python call
/// what waits.
void bind_threads(nb::module_& m);

/// Where Python before 3.14 ends a daemon thread: the thread stays here until the process ends. Its
/// frames cannot be unwound, as Python would have it, for those of the binding catch all
/// exceptions.
[[noreturn]] void stay_here();

/// Calls `use`, in which Python may end the thread. A forced unwinding is caught by a reference to
/// nothing, which UBSan would report. It leaves the stack marked as that of the frames it has
/// ended: ASan, which clears the marks before a call that does not return, reads some of them there
/// and would report those.
template <class Use>
__attribute__((noinline, no_sanitize("address", "undefined"))) void unless_ended(Use&& use) {
  try {
    use();
  } catch (abi::__forced_unwind&) {
    stay_here();
  }
}

/// Lets other threads of Python run as long as the object lives. The interpreter's end calls
/// `stop`, from its thread, and waits until the object is gone or has ended(). Raises SystemExit in
/// a daemon thread that comes after that.
class Released {
 public:
  explicit Released(std::function<void()> stop = {});
  ~Released();
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;

  /// What the interpreter's end has to wait for is done. From any thread.
  void ended();
  void stop() const;

  /// Calls `use` with the lock.
  template <class Use>
  void with_lock(Use&& use) {
    unless_ended([this] { take(); });
    try {
      unless_ended(use);
    } catch (...) {
      give();
      throw;
    }
    give();
  }

  /// Whether this process was forked while the object lived: other threads that had to do with it
  /// are not here.
  bool is_forked() const;

  /// Raises what signals raise in Python, and SystemExit where the interpreter ends.
  void check_signals();

 private:
  void take() { PyEval_RestoreThread(std::exchange(state_, nullptr)); }
  void give() { state_ = PyEval_SaveThread(); }
  std::function<void()> stop_;
  int fork_;
  PyThreadState* state_ = nullptr;
};

/// A mutex that is waited for without the interpreter's lock. Where a thread held it when the
/// process was forked, which the child does not have, the child gets a RunError.
class Lock {
 public:
  void lock();
  bool try_lock();
  void unlock() { mutex_.unlock(); }

 private:
  std::mutex mutex_;
  std::atomic<int> fork_ = -1;  // in which it was locked last
};

/// Holds the lock, which it waits for with the interpreter's lock released.
class Turn {
 public:
  explicit Turn(Lock& lock);
  ~Turn() { lock_.unlock(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  Lock& lock_;
};

/// Runs `work` on a thread of its own, the interpreter's lock released, and looks 20 times a second
/// for signals: one that raises calls `stop`, and is raised when the work has ended. `tick` is
/// called with the lock as often.
template <class Work, class Stop, class Tick>
void run_interruptibly(Work&& work, Stop&& stop, Tick&& tick) {
  std::mutex mutex;
  std::condition_variable ended;
  bool is_done = false;
  std::exception_ptr failure;
  std::exception_ptr raised;
  {
    Released released(stop);
    std::thread worker([&] {
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
      }
      released.ended();
      const std::lock_guard lock(mutex);
      is_done = true;
      ended.notify_all();
    });
    for (;;) {
      {
        std::unique_lock lock(mutex);
        if (ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return is_done; })) break;
      }
      if (raised) continue;
      try {
        released.with_lock([&] {
          if (PyErr_CheckSignals() != 0) throw nb::python_error();
          tick();
        });
      } catch (...) {
        raised = std::current_exception();
      }
      if (released.is_forked()) {
        new std::thread(std::move(
            worker));  // the parent's, which cannot be waited for: its object may not be destroyed
        if (raised) std::rethrow_exception(raised);
        throw caplet::RunError(
            "this process was forked while a call of caplet was under way, which does not go on in "
            "it");
      }
      if (raised) stop();
    }
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace caplet_python
