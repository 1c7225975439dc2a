// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes the man page in the macros of man(7).
#include <algorithm>

#include "cli/description.h"

namespace caplet::cli {

namespace {

/// Escapes text for roff, which prints a plain `-` as a hyphen that cannot be typed, and takes a
/// leading dot for a macro.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      case '"':
        out += "\\(dq";
        break;
      default:
        out += c;
    }
  }
  return out.starts_with('.') ? "\\&" + out : out;
}

/// Formats an option's values: literals in bold, placeholders in italics. A line may break after
/// each `|`.
std::string type_in_fonts(const std::string& type) {
  std::string out, word;
  const auto end_word = [&] {
    const bool is_word = std::ranges::none_of(
        word, [](char c) { return (c >= 'A' && c <= 'Z') || c == ',' || c == '['; });
    if (!word.empty()) out += (is_word ? "\\fB" : "\\fI") + escaped(word) + "\\fR";
    word.clear();
  };
  for (const char c : type) {
    if (c != '|') {
      word += c;
      continue;
    }
    end_word();
    out += "|\\:";
  }
  end_word();
  return out;
}

std::string names_in_bold(const OptionText& option) {
  std::string out;
  for (const std::string& name : option.names)
    out += (out.empty() ? "\\fB" : ", \\fB") + escaped(name) + "\\fR";
  if (option.type.empty()) return out;
  return out + (option.value_is_optional ? " [" + type_in_fonts(option.type) + "]"
                                         : " " + type_in_fonts(option.type));
}

void add_options(std::string& out, const std::vector<OptionText>& options) {
  for (const OptionText& option : options)
    out += ".TP\n" + names_in_bold(option) + "\n" + escaped(full_help(option)) + "\n";
}

void add_footer(std::string& out, const std::string& footer) {
  for (const FooterPart& part : footer_parts(footer)) {
    if (!part.is_literal) {
      out += ".PP\n" + escaped(part.lines.front()) + "\n";
      continue;
    }
    out += ".PP\n.nf\n";
    for (const std::string& line : part.lines) out += "\\&" + escaped(line) + "\n";
    out += ".fi\n";
  }
}

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

bool are_same(const std::vector<OptionText>& a, const std::vector<OptionText>& b) {
  return std::ranges::equal(a, b, [](const OptionText& x, const OptionText& y) {
    return x.names == y.names && x.type == y.type && x.help == y.help && x.usual == y.usual;
  });
}

/// A group of several commands is described once, after the commands.
struct SharedGroup {
  std::string name;
  std::vector<OptionText> options;
  std::vector<std::string> commands;
};

std::vector<SharedGroup> shared_groups(const ProgramText& program) {
  std::vector<SharedGroup> out;
  for (const CommandText& command : program.commands)
    for (const std::string& group : groups_of(command)) {
      const std::vector<OptionText> options = options_in(command, group);
      const auto same = std::ranges::find_if(out, [&](const SharedGroup& one) {
        return one.name == group && are_same(one.options, options);
      });
      if (same == out.end())
        out.push_back({group, options, {command.name}});
      else
        same->commands.push_back(command.name);
    }
  std::erase_if(out, [](const SharedGroup& one) { return one.commands.size() < 2; });
  return out;
}

bool is_shared(const std::vector<SharedGroup>& shared, const std::string& command,
               const std::string& group) {
  return std::ranges::any_of(shared, [&](const SharedGroup& one) {
    return one.name == group && std::ranges::find(one.commands, command) != one.commands.end();
  });
}

std::string listed(const std::vector<std::string>& names, const std::string& before,
                   const std::string& after) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0                  ? ""
            : i + 1 == names.size() ? " and "
                                    : ", ") +
           before + escaped(names[i]) + after;
  return out;
}

void add_command(std::string& out, const ProgramText& program, const CommandText& command,
                 const std::vector<SharedGroup>& shared) {
  const std::string name = program.program.name + " " + command.name;
  out += ".SH \"" + upper(name) + "\"\n.nh\n\\fB" + escaped(name) + "\\fR";
  if (!command.options.empty()) out += " [\\fIOPTIONS\\fR]";
  for (const OptionText& argument : command.arguments) out += " \\fI" + usage_of(argument) + "\\fR";
  out += "\n.hy\n.PP\n" + escaped(command.help) + ".\n";
  for (const OptionText& argument : command.arguments)
    out += ".TP\n\\fI" + usage_of(argument) + "\\fR\n" + escaped(full_help(argument)) + "\n";
  std::vector<std::string> elsewhere;
  for (const std::string& group : groups_of(command)) {
    if (is_shared(shared, command.name, group)) {
      elsewhere.push_back(group);
      continue;
    }
    out += ".SS \"" + escaped(group) + "\"\n";
    add_options(out, options_in(command, group));
  }
  if (!elsewhere.empty())
    out += ".PP\nIt also has the options of " + listed(elsewhere, "\\(lq", "\\(rq") +
           " in OPTIONS OF SEVERAL COMMANDS.\n";
  add_footer(out, command.footer);
}

}  // namespace

std::string man_page(const ProgramText& program) {
  const std::string& name = program.program.name;
  std::string help = short_help(program.program.help);
  if (help.ends_with('.')) help.pop_back();
  if (help.starts_with("Caplet ")) help.erase(0, 7);
  std::string out = ".\\\" Made by `caplet describe man`.\n.TH " + upper(name) + " 1 \"\" \"" +
                    name + " " + program.version + "\" \"User Commands\"\n.SH NAME\n" + name +
                    " \\- " + escaped(help) + "\n.SH SYNOPSIS\n";
  for (const CommandText& command : program.commands) {
    out += ".B \"" + name + " " + escaped(command.name) + "\"\n";
    out += command.options.empty() ? "" : "[\\fIOPTIONS\\fR]";
    for (const OptionText& argument : command.arguments)
      out += " \\fI" + usage_of(argument) + "\\fR";
    out += "\n.br\n";
  }
  out += ".SH DESCRIPTION\n" + escaped(program.program.help) + "\n.SH COMMANDS\n";
  for (const CommandText& command : program.commands)
    out += ".TP\n\\fB" + escaped(command.name) + "\\fR\n" + escaped(command.help) + ".\n";
  out += ".SH OPTIONS\n";
  add_options(out, program.program.options);
  const std::vector<SharedGroup> shared = shared_groups(program);
  for (const CommandText& command : program.commands) add_command(out, program, command, shared);
  out += ".SH OPTIONS OF SEVERAL COMMANDS\n";
  for (const SharedGroup& group : shared) {
    out += ".SS \"" + escaped(group.name) + "\"\n.PP\nOf " +
           listed(group.commands, "\\fB", "\\fR") + ":\n";
    add_options(out, group.options);
  }
  out += ".SH NOTES\n";
  add_footer(out, program.program.footer);
  return out;
}

}  // namespace caplet::cli
