// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Ctrl-C requests an orderly end; a second one ends the process at once.
#pragma once

#include <string>

namespace caplet {

/// Installs handlers for SIGINT, SIGTERM, SIGUSR1 and SIGHUP (unless ignored, as by nohup) that set
/// the flag. After a SIGINT or SIGTERM the next one has its default action. SIGHUP may come
/// repeatedly when a terminal closes, and SIGUSR1 from a scheduler before the end of a time limit:
/// they only set the flag.
void install_interrupt_handlers();
/// Installs the handler of SIGUSR1 again. Drivers that compile with LLVM replace it by one that
/// does nothing.
void renew_user_signal_handler();
bool interrupt_requested();
/// While an instance exists, the first of these signals ends the process at once with this exit
/// code, for there is nothing to finish: `message` is written to stderr, and the files that
/// write_atomically is writing are removed.
class EndsAtOnce {
 public:
  EndsAtOnce(std::string message, int code);
  ~EndsAtOnce();
  EndsAtOnce(const EndsAtOnce&) = delete;
  EndsAtOnce& operator=(const EndsAtOnce&) = delete;

 private:
  std::string message_;
};
/// Sets or clears the flag, for tests.
void set_interrupt_requested(bool requested);

}  // namespace caplet
