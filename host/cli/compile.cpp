// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "base/log.h"
#include "cli/commands.h"
#include "device/compilers.h"

namespace caplet::cli {

void add_compile(CLI::App& app) {
  CLI::App* command = app.add_subcommand("compile", "Compile kernels; other commands run this");
  command->group("");
  command->callback([] {
    log::set_quiet(true);
    compile_jobs_of(STDIN_FILENO);
  });
}

}  // namespace caplet::cli
