// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The subcommands: each adds itself to the program, with its options and its action. main.cpp
// catches their errors.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace caplet::cli {

/// The program's command line, for metadata and errors.
struct Invocation {
  std::vector<std::string> arguments;  // arguments[0] is the program
  /// Returns the command line quoted for a shell.
  std::string command_line() const;
};

void add_render(CLI::App& app, const Invocation& invocation);
void add_merge(CLI::App& app, const Invocation& invocation);
void add_film(CLI::App& app);
void add_convert(CLI::App& app);
void add_build(CLI::App& app);
void add_devices(CLI::App& app);
void add_doctor(CLI::App& app);
void add_pick(CLI::App& app);
void add_info(CLI::App& app);
void add_bench(CLI::App& app, const Invocation& invocation);
void add_verify(CLI::App& app);
void add_view(CLI::App& app);  // only if it is built (CAPLET_WITH_VIEW)
void add_help(CLI::App& app);
void add_try_device(CLI::App& app);  // hidden: see trial.h
void add_compile(CLI::App& app);     // hidden: see device/compilers.h
void add_describe(CLI::App& app);    // hidden: the man page and the completions

}  // namespace caplet::cli
