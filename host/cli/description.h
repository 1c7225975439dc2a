// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Plain values of what CLI11 knows of the program. Help, man page and completions are made from
// them.
//
// An option's type name in CLI11 describes its values, so that completions can read it:
// alternatives between `|`, of which those without capitals and commas are typed literally. Names
// in capitals are placeholders: FILE, FILE.npy and OUT.exr for a file, DIR for a folder, SCENE for
// a scene file, DEVICE for a device's index, LAYER for a layer's name, and others for values that
// cannot be listed. A final `,...` allows several values separated by commas.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace caplet::cli {

/// The possible values of an option.
struct Values {
  std::vector<std::string> words;       // typed literally
  std::vector<std::string> list_words;  // those that may form a list with commas
  bool files = false, folders = false, scenes = false, devices = false;
  bool devices_are_a_list = false;
};

/// Parses a type name in the form described above.
Values values_of(const std::string& type);

struct OptionText {
  std::vector<std::string> names;  // "-o", "--output"; a positional argument has only its name
  std::string type;                // its value; empty: a switch
  std::string help, usual, group;  // usual: the displayed default
  bool value_is_optional = false, is_repeated = false, is_required = false;
};

struct CommandText {
  std::string name, help, footer;
  std::vector<OptionText> arguments, options;
};

struct ProgramText {
  std::string version;
  CommandText program;
  std::vector<CommandText> commands;
};

/// Describes a command without its hidden options.
CommandText describe_command(const CLI::App& command);
/// Describes the program and its commands, without hidden ones.
ProgramText describe_program(const CLI::App& app);

/// Returns the groups of a command's options in their order.
std::vector<std::string> groups_of(const CommandText& command);
/// Returns the options of a group.
std::vector<OptionText> options_in(const CommandText& command, const std::string& group);

/// Returns the help without remarks and examples, for menus.
std::string short_help(const std::string& help);
/// Returns "SCENE...", "[SCENE...]": arguments as in a usage line.
std::string usage_of(const OptionText& argument);
/// Returns help and default together.
std::string full_help(const OptionText& option);

/// A part of a footer: a paragraph, which is filled, or lines that begin with two blanks, which
/// stay as they are.
struct FooterPart {
  bool is_literal = false;
  std::vector<std::string> lines;  // a single one for a paragraph
};
std::vector<FooterPart> footer_parts(const std::string& footer);
/// Makes a footer of examples and further remarks.
std::string footer_with(const std::vector<std::string>& examples, const std::string& more = "");

/// Breaks `text` into lines of at most `width` columns at blanks; a longer word is broken after a
/// `|`.
std::vector<std::string> filled(const std::string& text, std::size_t width);

// These texts are made from the description.
std::string help_text(const CommandText& command, const std::string& name,
                      const std::vector<CommandText>& commands);
std::string man_page(const ProgramText& program);
std::string bash_completion(const ProgramText& program);
std::string zsh_completion(const ProgramText& program);
std::string fish_completion(const ProgramText& program);

/// Replaces the program's help by that of help_text; must be called before commands are added.
void use_help_text(CLI::App& app);

}  // namespace caplet::cli
