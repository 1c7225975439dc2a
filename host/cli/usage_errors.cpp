// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/usage_errors.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/spelling.h"
#include "cli/description.h"

namespace caplet::cli {

namespace {

std::vector<std::string> option_names(const CommandText& command) {
  std::vector<std::string> out;
  for (const OptionText& option : command.options)
    out.insert(out.end(), option.names.begin(), option.names.end());
  return out;
}

std::string with_nearest(const std::string& message, const std::string& name,
                         const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? message : fmt::format("{}; the nearest is '{}'", message, nearest);
}

/// Returns "--size: its value WxH is missing" for CLI11's "--size: 1 required WxH missing", and
/// other messages as they are.
std::string with_missing_value(const std::string& message) {
  const std::string_view before = ": 1 required ", after = " missing";
  const std::size_t at = message.find(before);
  if (at == message.npos || !message.ends_with(after)) return message;
  const std::size_t begin = at + before.size();
  const std::string type = message.substr(begin, message.size() - after.size() - begin);
  return fmt::format("{}: its value {} is missing", message.substr(0, at),
                     type.substr(0, type.find(':')));
}

}  // namespace

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  // Those before a command's name are the program's.
  const bool is_of_program = chosen.empty() || !app.remaining().empty();
  const CLI::App& command = is_of_program ? app : *chosen.front();
  const std::vector<std::string> unknown = command.remaining();
  const auto is_of = [&](CLI::ExitCodes code) {
    return error.get_exit_code() == static_cast<int>(code);
  };
  // A misspelt option tells more than what is missing beside it.
  const bool is_told = chosen.empty() || is_of(CLI::ExitCodes::ExtrasError) ||
                       (is_of(CLI::ExitCodes::RequiredError) && !unknown.empty() &&
                        unknown.front().starts_with("-"));
  if (unknown.empty() || !is_told) return with_missing_value(error.what());
  // "--noize=3" is an option and its value.
  const std::string name = unknown.front().substr(0, unknown.front().find('='));
  if (name.starts_with("-"))
    return with_nearest(fmt::format("unknown option '{}'", name), name,
                        option_names(describe_command(command)));
  if (!is_of_program)
    return fmt::format("{}: unexpected argument '{}'", command.get_name(), unknown.front());
  std::vector<std::string> commands;
  for (const CommandText& one : describe_program(app).commands) commands.push_back(one.name);
  return with_nearest(fmt::format("unknown command '{}'", name), name, commands);
}

}  // namespace caplet::cli
