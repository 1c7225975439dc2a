// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes the text of --help, in 80 columns.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "base/error.h"
#include "base/spelling.h"
#include "cli/commands.h"
#include "cli/description.h"

namespace caplet::cli {

namespace {

constexpr std::size_t width = 80, help_column = 26;

/// Returns "  NAME    HELP". The help begins in its column, on the next line if the name is too
/// long.
std::string row(const std::string& name, const std::string& help) {
  std::vector<std::string> names = filled(name, width - 6);
  for (std::size_t i = 0; i < names.size(); ++i) names[i].insert(0, i == 0 ? 2 : 6, ' ');
  std::string out, line;
  for (const std::string& one : names) {
    if (!line.empty()) out += line + "\n";
    line = one;
  }
  for (const std::string& one : filled(help, width - help_column)) {
    if (line.size() + 1 > help_column) {
      out += line + "\n";
      line.clear();
    }
    line.resize(help_column, ' ');
    out += line + one + "\n";
    line.clear();
  }
  return line.empty() ? out : out + line + "\n";
}

std::string paragraph(const std::string& text) {
  std::string out;
  for (const std::string& line : filled(text, width)) out += line + "\n";
  return out;
}

std::string names_and_value(const OptionText& option) {
  std::string out;
  for (const std::string& name : option.names) out += (out.empty() ? "" : ", ") + name;
  if (option.type.empty()) return out;
  return out + (option.value_is_optional ? " [" + option.type + "]" : " " + option.type);
}

class HelpText : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    return help_text(describe_command(*app), name, describe_program(*app).commands);
  }
};

}  // namespace

std::string help_text(const CommandText& command, const std::string& name,
                      const std::vector<CommandText>& commands) {
  std::string usage = "Usage: " + name + (command.options.empty() ? "" : " [OPTIONS]");
  for (const OptionText& argument : command.arguments) usage += " " + usage_of(argument);
  if (!commands.empty()) usage += " COMMAND ...";
  std::string out = paragraph(command.help) + paragraph(usage);
  if (!command.arguments.empty()) {
    out += "\nArguments:\n";
    for (const OptionText& argument : command.arguments)
      out += row(usage_of(argument), full_help(argument));
  }
  if (!commands.empty()) {
    out += "\nCommands:\n";
    for (const CommandText& one : commands) out += row(one.name, one.help);
  }
  for (const std::string& group : groups_of(command)) {
    out += "\n" + group + ":\n";
    for (const OptionText& option : options_in(command, group))
      out += row(names_and_value(option), full_help(option));
  }
  const std::vector<FooterPart> footer = footer_parts(command.footer);
  for (std::size_t i = 0; i < footer.size(); ++i) {
    const FooterPart& part = footer[i];
    if (i == 0 || (footer[i - 1].is_literal && !part.is_literal)) out += "\n";
    if (!part.is_literal) out += paragraph(part.lines.front());
    if (part.is_literal)
      for (const std::string& line : part.lines) out += line + "\n";
  }
  return out;
}

void use_help_text(CLI::App& app) {
  // Later versions of CLI11 use other names for options without a group.
  app.option_defaults()->group("Options");
  app.formatter(std::make_shared<HelpText>());
}

void add_help(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("help", "Show the help of the program or of a command");
  command->add_option("COMMAND", *name, "Name of a command");
  command->footer(footer_with({"caplet help render"}));
  command->callback([&app, name] {
    const ProgramText program = describe_program(app);
    if (name->empty())
      return fmt::print("{}", help_text(program.program, "caplet", program.commands));
    std::vector<std::string> names;
    for (const CommandText& one : program.commands) {
      if (one.name == *name) return fmt::print("{}", help_text(one, "caplet " + one.name, {}));
      names.push_back(one.name);
    }
    throw InputError(SourceLocation{"help"},
                     fmt::format("there is no command '{}'; the nearest is '{}'", *name,
                                 nearest_name(*name, names)));
  });
}

}  // namespace caplet::cli
