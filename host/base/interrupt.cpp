// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/interrupt.h"

#include <csignal>

namespace caplet {

namespace {

volatile std::sig_atomic_t requested = 0;

void on_signal(int number) {
  requested = 1;
  std::signal(number, SIG_DFL);
}

}  // namespace

void install_interrupt_handlers() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}
bool interrupt_requested() { return requested != 0; }
void set_interrupt_requested(bool value) { requested = value ? 1 : 0; }

}  // namespace caplet
