// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/interrupt.h"

#include <csignal>

#include "base/atomic_file.h"

namespace caplet {

namespace {

volatile std::sig_atomic_t requested = 0;

volatile std::sig_atomic_t asked = 0;  // set by SIGINT or SIGTERM

void on_signal(int number) {
  requested = 1;
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
void set_interrupt_requested(bool value) { requested = value ? 1 : 0; }

}  // namespace caplet
