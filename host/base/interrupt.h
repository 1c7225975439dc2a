// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Ctrl-C asks for an orderly end; a second one ends the process at once.
#pragma once

namespace caplet {

/// Installs handlers for SIGINT and SIGTERM that set the flag; the second signal restores the default action.
void install_interrupt_handlers();
bool interrupt_requested();
/// For tests.
void set_interrupt_requested(bool requested);

}  // namespace caplet
