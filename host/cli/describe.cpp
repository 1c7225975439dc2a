// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet describe`: writes the man page and the completions during the build.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/description.h"

namespace caplet::cli {

namespace {

struct Text {
  const char* name;
  std::string (*make)(const ProgramText&);
};
constexpr std::array<Text, 4> texts = {{{"man", man_page},
                                        {"bash", bash_completion},
                                        {"zsh", zsh_completion},
                                        {"fish", fish_completion}}};

/// Returns CLI11's own help of each command, which tests compare with our texts.
std::string own_words(const CLI::App& app) {
  std::string out;
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
    out += "COMMAND " + command->get_name() + "\n" +
           CLI::Formatter().make_help(command, command->get_name(), CLI::AppFormatMode::Normal);
  return out;
}

}  // namespace

void add_describe(CLI::App& app) {
  const auto what = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("describe", "Print the man page or a completion: man, bash, zsh or fish");
  command->group("");
  command->add_option("WHAT", *what)->required();
  command->callback([&app, what] {
    if (*what == "cli11") return fmt::print("{}", own_words(app));
    for (const Text& text : texts)
      if (*what == text.name) return fmt::print("{}", text.make(describe_program(app)));
    throw CLI::ValidationError("WHAT", "'" + *what + "' is none of man, bash, zsh, fish, cli11");
  });
}

}  // namespace caplet::cli
