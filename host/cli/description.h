// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Plain values that say what CLI11 knows of the program. Help, man page and completions are made of them.
//
// An option's type name in CLI11 says what it takes, so that completions can read it: alternatives between `|`, of which
// those without capitals and commas are words to be typed as they are. Those with capitals stand for something: FILE, FILE.npy
// and OUT.exr for a file, DIR for a folder, SCENE for a scene file, DEVICE for a device's index, LAYER for a layer's name,
// anything else for what cannot be listed. `,...` behind one says that several may stand between commas.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace caplet::cli {

/// What can be typed behind an option.
struct Values {
  std::vector<std::string> words;       // typed as they are
  std::vector<std::string> list_words;  // those of which several may stand between commas
  bool files = false, folders = false, scenes = false, devices = false;
  bool devices_are_a_list = false;
};

/// Reads a type name as above.
Values values_of(const std::string& type);

struct OptionText {
  std::vector<std::string> names;  // "-o", "--output"; of an argument its name alone
  std::string type;                // what follows; empty: a switch
  std::string help, usual, group;  // usual: the default, as it is shown
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

/// A command without what is hidden in it.
CommandText describe_command(const CLI::App& command);
/// The program and its commands, without what is hidden.
ProgramText describe_program(const CLI::App& app);

/// The groups of a command's options, in their order.
std::vector<std::string> groups_of(const CommandText& command);
/// The options of a group.
std::vector<OptionText> options_in(const CommandText& command, const std::string& group);

/// The help without remarks and examples: what a menu has room for.
std::string short_help(const std::string& help);
/// "SCENE...", "[SCENE...]": arguments as a usage line has them.
std::string usage_of(const OptionText& argument);
/// Help and default in one.
std::string full_help(const OptionText& option);

/// A footer's parts: paragraphs, which are filled, and lines that begin with two blanks, which stand as they are.
struct FooterPart {
  bool is_literal = false;
  std::vector<std::string> lines;  // of a paragraph one
};
std::vector<FooterPart> footer_parts(const std::string& footer);
/// A footer of examples, and what there is to say beside them.
std::string footer_with(const std::vector<std::string>& examples, const std::string& more = "");

/// `text` in lines of at most `width` columns, broken at blanks; a longer word is broken behind a `|`.
std::vector<std::string> filled(const std::string& text, std::size_t width);

// Texts that are made of it.
std::string help_text(const CommandText& command, const std::string& name, const std::vector<CommandText>& commands);
std::string man_page(const ProgramText& program);
std::string bash_completion(const ProgramText& program);
std::string zsh_completion(const ProgramText& program);
std::string fish_completion(const ProgramText& program);

/// Makes the program's help that of help_text; call it before commands are added.
void use_help_text(CLI::App& app);

}  // namespace caplet::cli
