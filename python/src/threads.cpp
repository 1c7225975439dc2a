// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "threads.h"

#include <pthread.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <set>

namespace caplet_python {

namespace {

/// What runs without the interpreter's lock.
struct UnderWay {
  std::mutex mutex;  // held for moments, by none who waits for the interpreter's lock
  std::condition_variable ended;
  std::set<Released*> all;
  std::optional<std::thread::id> exiting;  // the thread that ends the interpreter
};

std::atomic<UnderWay*> under_way = new UnderWay;
std::atomic<int> forks = 0;  // since the process with the first ancestor that has this module

/// Ends the process without what libraries of the parent do at an exit. Some wait there for threads
/// that a child does not have: log4cplus, which Debian 12's OpenImageIO brings by way of OpenVDB.
/// Python itself has ended before.
void leave(int status, void*) {
  std::fflush(nullptr);
  ::_exit(status);
}

/// The parent's threads are not here, but may hold the mutex.
void in_child() {
  ++forks;
  under_way = new UnderWay;
#ifdef __GLIBC__
  ::on_exit(leave, nullptr);
#endif
}

[[maybe_unused]] const int registered = ::pthread_atfork(nullptr, nullptr, in_child);

[[noreturn]] void raise_exit() {
  PyErr_SetNone(PyExc_SystemExit);
  throw nb::python_error();
}

bool is_ending(const UnderWay& now) {
  return now.exiting && *now.exiting != std::this_thread::get_id();
}

/// Ends what is under way in daemon threads: Python is about to end them, and the process to take
/// OpenCL down beneath them.
void at_exit() {
  UnderWay& now = *under_way;
  {
    const std::lock_guard lock(now.mutex);
    now.exiting = std::this_thread::get_id();
    for (Released* one : now.all) one->stop();
  }
  for (;;) {
    {
      Released released;  // is among them itself
      std::unique_lock lock(now.mutex);
      if (now.ended.wait_for(lock, std::chrono::milliseconds(50),
                             [&] { return now.all.size() == 1; }))
        return;
    }
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
}

}  // namespace

void bind_threads(nb::module_& m) {
  m.def("_at_exit", at_exit);
  nb::module_::import_("atexit").attr("register")(m.attr("_at_exit"));
  // A daemon thread has what it has until the end. That is no leak to tell users of.
  nb::set_leak_warnings(false);
}

void stay_here() {
  for (;;) ::pause();
}

Released::Released(std::function<void()> stop) : stop_(std::move(stop)), fork_(forks) {
  UnderWay& now = *under_way;
  {
    const std::lock_guard lock(now.mutex);
    if (is_ending(now)) raise_exit();
    now.all.insert(this);
  }
  give();
}

Released::~Released() {
  unless_ended([this] { take(); });
  ended();
}

void Released::stop() const {
  if (stop_) stop_();
}

void Released::ended() {
  UnderWay& now = *under_way;
  const std::lock_guard lock(now.mutex);
  now.all.erase(this);
  now.ended.notify_all();
}

bool Released::is_forked() const { return fork_ != forks; }

void Released::check_signals() {
  with_lock([] {
    UnderWay& now = *under_way;
    {
      const std::lock_guard lock(now.mutex);
      if (is_ending(now)) raise_exit();
    }
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  });
}

bool Lock::try_lock() {
  if (!mutex_.try_lock()) return false;
  fork_ = forks.load();
  return true;
}

void Lock::lock() {
  if (try_lock()) return;
  if (fork_ != forks)
    throw caplet::RunError(
        "another thread was using this when the process was forked: it is not to be had here");
  mutex_.lock();
  fork_ = forks.load();
}

Turn::Turn(Lock& lock) : lock_(lock) {
  if (lock.try_lock()) return;
  const Released released;
  lock.lock();
}

}  // namespace caplet_python
