// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/second_try.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <vector>

#include "base/atomic_file.h"
#include "base/environment.h"
#include "base/log.h"
#include "device/bundled.h"
#include "device/pocl_needs.h"

extern char** environ;

namespace caplet {

namespace fs = std::filesystem;

namespace {

constexpr const char* marker =
    "CAPLET_DRIVER_FAILED";  // set for the second process: the first one's signal, 0 for an error
constexpr const char* cache_marker =
    "CAPLET_DRIVER_CACHE";  // likewise: the cache folder that the driver used
constexpr int signals[] = {SIGABRT, SIGBUS, SIGSEGV, SIGILL};

enum State : int { off, guarded, second, ending };
std::atomic<int> state{off};
static_assert(std::atomic<int>::is_always_lock_free, "handlers of signals use it");

// The signal handler needs these; they are prepared because it may not allocate.
struct sigaction before[std::size(signals)];
char** program_arguments = nullptr;
bool is_second = false;
std::string damaged;  // the folder with the damaged cache
std::vector<std::string> variables;
std::vector<char*> environment;
char* signal_digits = nullptr;  // two, within `variables`
sigset_t mask;
constexpr char in_vain[] =
    "caplet: error: the driver failed with a fresh cache folder as well, so PoCL's cache is not "
    "the reason; `caplet doctor` "
    "tells "
    "more\n";

/// Replaces the process; returns when that fails. It is safe in signal handlers.
void run_again(int number) {
  signal_digits[0] = static_cast<char>('0' + number / 10);
  signal_digits[1] = static_cast<char>('0' + number % 10);
  ::sigprocmask(SIG_SETMASK, &mask, nullptr);
  ::execve("/proc/self/exe", program_arguments, environment.data());
}

void on_crash(int number) {
  int was = guarded;
  if (state.compare_exchange_strong(was, ending)) {
    remove_temporary_files();
    run_again(number);
  } else if (was == ending) {
    for (;;) ::pause();  // another thread is about to replace the process
  } else if (was == second) {
    remove_temporary_files();
    (void)!::write(STDERR_FILENO, in_vain, sizeof in_vain - 1);
    ::_exit(1);
  }
  ::signal(number, SIG_DFL);
  ::raise(number);
}

/// PoCL's LLVM has handlers of its own, which end the process; they are put back where a crash is
/// no longer this program's.
void handle_signals(bool on) {
  struct sigaction ours {};
  ours.sa_handler = on_crash;
  sigemptyset(&ours.sa_mask);
  for (std::size_t i = 0; i < std::size(signals); ++i) {
    struct sigaction now {};
    ::sigaction(signals[i], nullptr, &now);
    const bool is_ours = (now.sa_flags & SA_SIGINFO) == 0 && now.sa_handler == on_crash;
    if (on && !is_ours)
      ::sigaction(signals[i], &ours, &before[i]);
    else if (!on && is_ours)
      ::sigaction(signals[i], &before[i], nullptr);
  }
}

void prepare(const Device& device) {
  variables.clear();
  for (char** one = environ; *one; ++one) variables.emplace_back(*one);
  const fs::path cache = used_cache_folder(device.info().bundled);
  variables.push_back(fmt::format("{}={}", cache_marker, cache.string()));
  variables.push_back(fmt::format("{}=00", marker));
  environment.clear();
  for (std::string& one : variables) environment.push_back(one.data());
  environment.push_back(nullptr);
  signal_digits = variables.back().data() + variables.back().size() - 2;
  ::sigprocmask(SIG_SETMASK, nullptr, &mask);
}

/// Returns whether PoCL may report this error for files of its cache that hold no program, or not
/// this one.
bool may_be_the_cache(cl_int code) {
  switch (code) {
    case CL_INVALID_KERNEL_NAME:
    case CL_INVALID_BINARY:
    case CL_INVALID_PROGRAM_EXECUTABLE:
    case CL_INVALID_KERNEL_DEFINITION:
    case CL_LINK_PROGRAM_FAILURE:
    case CL_OUT_OF_RESOURCES:
      return true;
    default:
      return false;
  }
}

}  // namespace

FreshPoclCache::FreshPoclCache() {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "caplet-pocl-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw RunError(fmt::format("{}: no fresh cache folder: {}", name, std::strerror(errno)));
  folder_ = name;
  if (const char* before = std::getenv("POCL_CACHE_DIR")) before_ = before;
  ::setenv("POCL_CACHE_DIR", name.c_str(), 1);
}

FreshPoclCache::~FreshPoclCache() {
  std::error_code error;
  fs::remove_all(folder_, error);
  if (before_)
    ::setenv("POCL_CACHE_DIR", before_->c_str(), 1);
  else
    ::unsetenv("POCL_CACHE_DIR");
}

SecondTry::SecondTry(char** arguments) {
  program_arguments = arguments;
  const std::string failed = environment_variable(marker);
  is_second = !failed.empty();
  if (!is_second) return;
  ::unsetenv(marker);
  damaged = environment_variable(cache_marker);
  ::unsetenv(cache_marker);
  fresh_.emplace();
  const int number = std::atoi(failed.c_str());
  log::warn("PoCL failed{}: trying once more with a fresh cache folder in place of '{}'",
            number > 0 ? fmt::format(" with signal {} ({})", number, ::strsignal(number)) : "",
            damaged);
}

SecondTry::~SecondTry() {
  if (state.exchange(off) != off) handle_signals(false);
  program_arguments = nullptr;
}

void SecondTry::guard(const Device& device) {
  if (!program_arguments || !device.is_pocl()) return;
  if (state == off) {
    prepare(device);
    state = is_second ? second : guarded;
  }
  handle_signals(true);
}

void SecondTry::driver_works() {
  const int was = state.exchange(off);
  if (was == off) return;
  handle_signals(false);
  if (was == second)
    log::warn("PoCL works with a fresh cache folder, so its own is damaged: delete it (rm -r '{}')",
              damaged);
}

void SecondTry::after(const DriverError& error) {
  int was = guarded;
  if (may_be_the_cache(error.code()) && state.compare_exchange_strong(was, ending)) run_again(0);
}

}  // namespace caplet
