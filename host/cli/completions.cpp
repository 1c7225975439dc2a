// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes completions for bash, zsh and fish.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/description.h"
#include "cli/options.h"

namespace caplet::cli {

namespace {

/// Quotes text with single quotes, which all three shells read alike.
std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

std::vector<std::string> command_names(const std::vector<CommandText>& commands) {
  std::vector<std::string> out;
  for (const CommandText& command : commands) out.push_back(command.name);
  return out;
}

std::vector<std::string> option_names(const CommandText& command) {
  std::vector<std::string> out;
  for (const OptionText& option : command.options)
    out.insert(out.end(), option.names.begin(), option.names.end());
  return out;
}

bool is_long(const std::string& name) { return name.starts_with("--"); }

/// Returns the possible values of the positional arguments.
Values values_of_arguments(const CommandText& command) {
  return command.arguments.empty() ? Values{} : values_of(command.arguments.front().type);
}

// --- bash ---

/// Returns calls of the functions below that add the possible values.
std::string bash_values(const Values& values) {
  std::string out;
  if (!values.words.empty())
    out += fmt::format("_caplet_words {}; ", in_quotes(joined(values.words)));
  if (!values.list_words.empty())
    out += fmt::format("_caplet_list {}; ", in_quotes(joined(values.list_words)));
  if (values.devices)
    out += fmt::format("{} \"$(_caplet_devices)\"; ",
                       values.devices_are_a_list ? "_caplet_list" : "_caplet_words");
  if (values.scenes) out += "_caplet_scenes; ";
  if (values.files) out += "_caplet_files -f; ";
  if (values.folders) out += "_caplet_files -d; ";
  return out;
}

constexpr const char* bash_functions =
    R"sh(_caplet_words() { COMPREPLY+=($(compgen -W "$1" -- "$_caplet_cur")); }

_caplet_list() {
  local before=
  case $_caplet_cur in *,*) before=${_caplet_cur%,*}, ;; esac
  COMPREPLY+=($(compgen -P "$before" -W "$1" -- "${_caplet_cur##*,}"))
}

_caplet_devices() { "$_caplet_program" devices 2>/dev/null | sed 's/ .*//'; }

_caplet_files() {
  local file
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do COMPREPLY+=("$file"); done < <(compgen "$1" -- "$_caplet_cur")
}

_caplet_scenes() {
  local file
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [ -d "$file" ]; then
      COMPREPLY+=("$file")
    else
      case $file in @EXTENSIONS@) COMPREPLY+=("$file") ;; esac
    fi
  done < <(compgen -f -- "$_caplet_cur")
}
)sh";

/// Returns the extensions of scene files, and of trees in place of them.
std::string file_extensions() { return scene_extensions() + " .tree"; }

std::string extension_patterns() { return "*" + replaced(file_extensions(), " ", " | *"); }

std::string bash_command(const CommandText& command) {
  std::string out = fmt::format("    {})\n      options={}\n      case $previous in\n",
                                command.name, in_quotes(joined(option_names(command))));
  for (const OptionText& option : command.options) {
    if (option.type.empty()) continue;
    // Options are still offered where the value may be omitted.
    const std::string guard =
        option.value_is_optional ? "[ \"${_caplet_cur#-}\" != \"$_caplet_cur\" ] || { " : "";
    out += fmt::format("        {}) {}{}{} ;;\n", fmt::join(option.names, " | "), guard,
                       bash_values(values_of(option.type)),
                       option.value_is_optional ? "return; }" : "return");
  }
  return out + "      esac\n      ;;\n";
}

// --- zsh ---

/// Escapes text inside the brackets of a specification of _arguments.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_action(const Values& values) {
  std::vector<std::string> parts;
  if (!values.words.empty()) parts.push_back(fmt::format("words:value:({})", joined(values.words)));
  if (!values.list_words.empty())
    parts.push_back(fmt::format("list:value:_caplet_list {}", joined(values.list_words)));
  if (values.devices) parts.emplace_back("devices:device:_caplet_devices");
  if (values.scenes) parts.emplace_back("files:scene:_caplet_scenes");
  if (values.files) parts.emplace_back("files:file:_files");
  if (values.folders) parts.emplace_back("files:folder:_files -/");
  if (parts.empty()) return " ";
  std::string out = "_alternative";
  for (const std::string& part : parts) out += " \"" + part + "\"";
  return "{" + replaced(out, ":", "\\:") + "}";
}

std::string zsh_option(const OptionText& option) {
  const bool is_many = option.is_repeated;
  std::string out;
  for (const std::string& name : option.names) {
    std::string spec = is_many                   ? "*"
                       : option.names.size() > 1 ? "(" + joined(option.names) + ")"
                                                 : "";
    spec += name;
    if (!option.type.empty() && is_long(name)) spec += "=";
    if (!option.type.empty() && !is_long(name)) spec += "+";
    spec += "[" + zsh_text(short_help(option.help)) + "]";
    if (!option.type.empty())
      spec += (option.value_is_optional ? "::" : ":") + zsh_text(option.type) + ":" +
              zsh_action(values_of(option.type));
    out += "        " + in_quotes(spec) + " \\\n";
  }
  return out;
}

std::string zsh_command(const CommandText& command) {
  std::string out = fmt::format("    {})\n      _arguments -s \\\n", command.name);
  for (const OptionText& option : command.options) out += zsh_option(option);
  for (const OptionText& argument : command.arguments)
    out += "        " +
           in_quotes((argument.is_repeated ? "*:" : ":") + zsh_text(argument.names.front()) + ":" +
                     zsh_action(values_of(argument.type))) +
           " \\\n";
  return out + "        && return\n      ;;\n";
}

// --- fish ---

std::string fish_values(const Values& values) {
  std::vector<std::string> parts = values.words;
  if (!values.list_words.empty())
    parts.push_back(fmt::format("(__fish_append , {})", joined(values.list_words)));
  if (values.devices) parts.emplace_back("(__caplet_devices)");
  if (values.scenes) parts.push_back(fmt::format("(__fish_complete_suffix {})", file_extensions()));
  if (values.folders && !values.files) parts.emplace_back("(__fish_complete_directories)");
  return joined(parts);
}

std::string fish_option(const std::string& command, const OptionText& option) {
  std::string out = fmt::format("complete -c caplet -n '__fish_seen_subcommand_from {}'", command);
  for (const std::string& name : option.names)
    out += is_long(name) ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.type.empty()) {
    const Values values = values_of(option.type);
    const std::string words = fish_values(values);
    // -r requires a value; -f excludes files, and -F allows them.
    out += option.value_is_optional ? "" : " -r";
    out += values.files ? " -F" : " -f";
    if (!words.empty()) out += " -a " + in_quotes(words);
  }
  return out + " -d " + in_quotes(short_help(option.help)) + "\n";
}

}  // namespace

std::string bash_completion(const ProgramText& program) {
  std::string out = "# Completion of caplet for bash. Made by `caplet describe bash`.\n";
  out += replaced(bash_functions, "@EXTENSIONS@", extension_patterns());
  out += fmt::format(R"sh(
_caplet() {{
  local _caplet_program=${{COMP_WORDS[0]}} _caplet_cur=${{COMP_WORDS[COMP_CWORD]}} previous= command= options= i IFS=$' \t\n'
  [ "$COMP_CWORD" -lt 2 ] || previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  COMPREPLY=()
  # --option=value: bash takes `=` for a word.
  if [ "$_caplet_cur" = = ]; then
    _caplet_cur=
  elif [ "$previous" = = ]; then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${{COMP_WORDS[i]}} in
      -*) ;;
      *) command=${{COMP_WORDS[i]}} && break ;;
    esac
  done
  case $command in
    '') options={} ;;
)sh",
                     in_quotes(joined(option_names(program.program))));
  for (const CommandText& command : program.commands) out += bash_command(command);
  out +=
      "  esac\n  case $_caplet_cur in -*) _caplet_words \"$options\" && return ;; esac\n  case "
      "$command in\n";
  out += fmt::format("    '') _caplet_words {} ;;\n",
                     in_quotes(joined(command_names(program.commands))));
  for (const CommandText& command : program.commands)
    if (const std::string values = bash_values(values_of_arguments(command)); !values.empty())
      out += fmt::format("    {}) {};;\n", command.name, values);
  return out + "  esac\n}\ncomplete -F _caplet caplet\n";
}

std::string zsh_completion(const ProgramText& program) {
  std::string out = R"sh(#compdef caplet
# Completion of caplet for zsh. Made by `caplet describe zsh`.

_caplet_devices() {
  local -a devices
  devices=(${(f)"$(_call_program devices caplet devices 2>/dev/null | sed 's/:/\\:/g; s/  */:/')"})
  _describe -t devices device devices
}

# _alternative gives options of compadd first; the words follow them.
_caplet_list() {
  local -a words
  words=(${argv:#-*})
  _values -s , value $words
}

)sh";
  std::string globs = replaced(file_extensions(), " .", "|");
  if (globs.starts_with('.')) globs.erase(0, 1);
  out += fmt::format("_caplet_scenes() {{ _files -g '*.({})(-.)'; }}\n", globs);
  out +=
      "\n_caplet() {\n  local curcontext=$curcontext state line\n  local -a commands\n  "
      "commands=(\n";
  for (const CommandText& command : program.commands)
    out += "    " + in_quotes(command.name + ":" + zsh_text(short_help(command.help))) + "\n";
  out += "  )\n  _arguments -C \\\n";
  for (const OptionText& option : program.program.options) out += zsh_option(option);
  out += "        '1:command:->command' \\\n        '*::argument:->argument' && return\n";
  out +=
      "  if [[ $state == command ]]; then\n    _describe -t commands command commands\n    "
      "return\n  fi\n  case $words[1] in\n";
  for (const CommandText& command : program.commands) out += zsh_command(command);
  return out + "  esac\n}\n\n_caplet \"$@\"\n";
}

std::string fish_completion(const ProgramText& program) {
  std::string out = R"sh(# Completion of caplet for fish. Made by `caplet describe fish`.
function __caplet_devices
    caplet devices 2>/dev/null | string replace -r '^(\d+) +(.*)$' '$1\t$2'
end

complete -c caplet -f
)sh";
  for (const OptionText& option : program.program.options)
    out += replaced(fish_option("", option), "'__fish_seen_subcommand_from '",
                    "__fish_use_subcommand");
  for (const CommandText& command : program.commands)
    out += fmt::format("complete -c caplet -n __fish_use_subcommand -a {} -d {}\n", command.name,
                       in_quotes(short_help(command.help)));
  for (const CommandText& command : program.commands) {
    for (const OptionText& option : command.options) out += fish_option(command.name, option);
    const Values values = values_of_arguments(command);
    if (values.scenes || values.files)
      out += fmt::format("complete -c caplet -n '__fish_seen_subcommand_from {}' {} -a {}\n",
                         command.name, values.files ? "-F" : "-f", in_quotes(fish_values(values)));
  }
  return out;
}

}  // namespace caplet::cli
