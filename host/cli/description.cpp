// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/description.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "film/layers.h"

namespace caplet::cli {

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == separator)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \n");
  return first == std::string::npos ? std::string()
                                    : text.substr(first, text.find_last_not_of(" \n") - first + 1);
}

bool has_capitals(const std::string& text) {
  return std::ranges::any_of(text, [](unsigned char c) { return std::isupper(c); });
}

/// CLI11 appends the description of each check to the name, after a colon.
std::string type_of(const CLI::Option& option) {
  std::string checks;
  try {
    // CLI11 offers neither constant access to checks nor their number.
    for (int i = 0;; ++i)
      if (const std::string says =
              const_cast<CLI::Option&>(option).get_validator(i)->get_description();
          !says.empty())
        checks += ":" + says;
  } catch (const CLI::OptionNotFound&) {
    const std::string whole = option.get_type_name();
    return whole.ends_with(checks) ? whole.substr(0, whole.size() - checks.size()) : whole;
  }
}

OptionText describe_option(const CLI::Option& option) {
  OptionText out;
  if (option.nonpositional())
    for (const std::string& name : split(option.get_name(false, true), ','))
      out.names.push_back(trimmed(name));
  else
    out.names.push_back(option.get_name(true));
  if (option.get_expected_max() > 0) out.type = type_of(option);
  out.help = option.get_description();
  out.usual = option.get_default_str();
  out.group = option.get_group();
  out.value_is_optional = option.get_expected_max() > 0 && option.get_expected_min() == 0;
  out.is_repeated = option.get_expected_max() >= CLI::detail::expected_max_vector_size ||
                    option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  out.is_required = option.get_required();
  return out;
}

}  // namespace

Values values_of(const std::string& type) {
  Values out;
  for (std::string word : split(type, '|')) {
    const bool is_list = word.ends_with(",...");
    if (is_list) word.resize(word.size() - 4);
    if (word.empty()) continue;
    if (word == "FILE" || word.starts_with("FILE.") || word.starts_with("OUT.")) {
      out.files = true;
    } else if (word == "DIR") {
      out.folders = true;
    } else if (word == "SCENE") {
      out.scenes = true;
    } else if (word == "DEVICE") {
      out.devices = true;
      out.devices_are_a_list = is_list;
    } else if (word == "LAYER") {
      for (const LayerRow& row : layer_rows)
        if (*row.option) out.list_words.emplace_back(row.option);
    } else if (!has_capitals(word) && word.find_first_of(",[]") == std::string::npos) {
      (is_list ? out.list_words : out.words).push_back(word);
    }
  }
  return out;
}

CommandText describe_command(const CLI::App& command) {
  CommandText out{command.get_name(), command.get_description(), command.get_footer(), {}, {}};
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    (option->nonpositional() ? out.options : out.arguments).push_back(describe_option(*option));
  }
  // The option --help comes last, because every command has it.
  std::stable_partition(out.options.begin(), out.options.end(), [](const OptionText& option) {
    return std::ranges::find(option.names, "--help") == option.names.end();
  });
  return out;
}

ProgramText describe_program(const CLI::App& app) {
  ProgramText out{CAPLET_VERSION, describe_command(app), {}};
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
    out.commands.push_back(describe_command(*command));
  return out;
}

std::vector<std::string> groups_of(const CommandText& command) {
  std::vector<std::string> out;
  for (const OptionText& option : command.options)
    if (std::ranges::find(out, option.group) == out.end()) out.push_back(option.group);
  return out;
}

std::vector<OptionText> options_in(const CommandText& command, const std::string& group) {
  std::vector<OptionText> out;
  std::ranges::copy_if(command.options, std::back_inserter(out),
                       [&](const OptionText& one) { return one.group == group; });
  return out;
}

std::string short_help(const std::string& help) {
  std::size_t end = help.size();
  for (const char* mark : {"; ", ": ", " (", ", such as "}) end = std::min(end, help.find(mark));
  return help.substr(0, end);
}

std::string usage_of(const OptionText& argument) {
  const std::string name = argument.names.front() + (argument.is_repeated ? "..." : "");
  return argument.is_required ? name : "[" + name + "]";
}

std::string full_help(const OptionText& option) {
  return option.usual.empty()
             ? option.help
             : option.help + (option.help.empty() ? "" : " ") + "(default: " + option.usual + ")";
}

std::vector<FooterPart> footer_parts(const std::string& footer) {
  std::vector<FooterPart> out;
  for (const std::string& line : split(footer, '\n')) {
    if (line.empty()) continue;
    const bool is_literal = line.starts_with("  ");
    if (is_literal && !out.empty() && out.back().is_literal)
      out.back().lines.push_back(line);
    else
      out.push_back({is_literal, {line}});
  }
  return out;
}

std::string footer_with(const std::vector<std::string>& examples, const std::string& more) {
  std::string out = examples.size() == 1 ? "Example:" : "Examples:";
  for (const std::string& example : examples) out += "\n  " + example;
  return more.empty() ? out : out + "\n" + more;
}

std::vector<std::string> filled(const std::string& text, std::size_t width) {
  std::vector<std::string> out;
  for (std::string word : split(text, ' ')) {
    if (word.empty()) continue;
    if (!out.empty() && out.back().size() + 1 + word.size() <= width) {
      out.back() += " " + word;
      continue;
    }
    while (word.size() > width) {
      const std::size_t bar = word.rfind('|', width - 1);
      const std::size_t size = bar == std::string::npos ? width : bar + 1;
      out.push_back(word.substr(0, size));
      word.erase(0, size);
    }
    out.push_back(word);
  }
  return out;
}

}  // namespace caplet::cli
