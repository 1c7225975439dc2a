// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet bench`: starts caplet_bench, the benchmark program built beside this one.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/description.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

/// Takes arguments as they were typed behind `bench`. Only a request for this command's help is
/// left to the caller.
void run_bench(std::vector<std::string> arguments) {
  if (!arguments.empty() && (arguments[0] == "-h" || arguments[0] == "--help")) return;
  if (!arguments.empty() && arguments[0] == "--") arguments.erase(arguments.begin());
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path() / "caplet_bench";
  if (error || !fs::exists(program, error))
    throw InputError(
        "bench: caplet_bench is not built; configure with -DCAPLET_BENCH=ON and build again");
  std::vector<char*> argv;
  std::string name = program.string();
  argv.push_back(name.data());
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(name.c_str(), argv.data());
  throw RunError(fmt::format("{}: cannot be run: {}", name, std::strerror(errno)));
}

}  // namespace

void add_bench(CLI::App& app, const Invocation& invocation) {
  CLI::App* command =
      app.add_subcommand("bench", "Measure ray tracing speed side by side with Embree");
  command->footer(
      footer_with({"caplet bench capsules --n 1000000"},
                  "Arguments go to the benchmark program; `caplet bench -- --help` lists them."));
  command->preparse_callback(
      [&invocation](std::size_t count) {  // CLI11 would take `-- --help` for itself
        const std::vector<std::string>& all = invocation.arguments;
        run_bench({all.end() - static_cast<std::ptrdiff_t>(count), all.end()});
      });
}

}  // namespace caplet::cli
