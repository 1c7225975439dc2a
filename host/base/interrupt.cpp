// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <cstring>
#include <utility>

#include "base/atomic_file.h"

namespace caplet {

namespace {

volatile std::sig_atomic_t requested = 0;

volatile std::sig_atomic_t asked = 0;  // set by SIGINT or SIGTERM

const char* volatile last_words = nullptr;  // of EndsAtOnce
volatile std::sig_atomic_t last_code = 0, on_terminal = 0;
constexpr char clear_line[] = "\r\x1b[K";

void say(const char* text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
}

void on_signal(int number) {
  requested = 1;
  if (const char* const words = last_words) {
    remove_temporary_files();
    if (on_terminal) say(clear_line);
    say(words);
    ::_exit(last_code);
  }
  if (number == SIGHUP || number == SIGUSR1) return;
  if (asked) {
    remove_temporary_files();
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  asked = 1;
}

}  // namespace

void install_interrupt_handlers() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  renew_user_signal_handler();
  if (std::signal(SIGHUP, on_signal) == SIG_IGN)
    std::signal(SIGHUP, SIG_IGN);  // nohup ignores SIGHUP
}
void renew_user_signal_handler() { std::signal(SIGUSR1, on_signal); }
bool interrupt_requested() { return requested != 0; }
EndsAtOnce::EndsAtOnce(std::string message, int code) : message_(std::move(message)) {
  last_code = code;
  on_terminal = ::isatty(STDERR_FILENO);
  last_words = message_.c_str();
}
EndsAtOnce::~EndsAtOnce() { last_words = nullptr; }
void set_interrupt_requested(bool value) { requested = value ? 1 : 0; }

}  // namespace caplet
