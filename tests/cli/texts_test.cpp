// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Help, man page and completions: all that CLI11 says of the program is in them, and shells take
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Names = std::vector<std::string>;

std::string output_of(const Names& arguments) {
  const test::Result result = test::run_program(arguments, test::folder_with_scene());
  EXPECT_EQ(result.code, 0) << testing::PrintToString(arguments) << result.err;
  return result.out;
}

/// The names of the options of each command, from CLI11's own help of everything.
const std::map<std::string, std::set<std::string>>& options_by_command() {
  static const auto all = [] {
    std::map<std::string, std::set<std::string>> out;
    std::string command;
    for (const std::string& line : test::lines_of(output_of({"describe", "cli11"}))) {
      static const std::regex options("^\\s+(-[^ ]+(, +-[^ ]+)*)"), one("--?[a-z][a-z-]*");
      std::smatch found;
      if (line.starts_with("COMMAND ")) command = line.substr(8);
      if (command.empty() || !std::regex_search(line, found, options)) continue;
      const std::string names = found[1];
      for (std::sregex_iterator i(names.begin(), names.end(), one), end; i != end; ++i)
        out[command].insert(i->str());
    }
    return out;
  }();
  return all;
}

bool has(const std::string& text, const std::string& regex) {
  return std::regex_search(text, std::regex(regex));
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) return {};
  return text.substr(from, text.find(end, from + begin.size()) - from);
}

/// Text as a man page has it.
std::string in_roff(const std::string& name) {
  return std::regex_replace(name, std::regex("-"), "\\-");
}

/// What bash offers for the last word. `words` are as bash divides a line.
class Bash {
 public:
  Bash() {
    test::write_file(folder_ / "caplet.bash", output_of({"describe", "bash"}));
    // In place of the program, whose devices are those of this machine.
    test::write_file(
        folder_ / "caplet",
        "#!/bin/sh\n[ \"$1\" != devices ] || printf '0  cpu  One\\n1  gpu  Another\\n'\n");
    fs::permissions(folder_ / "caplet", fs::perms::owner_all);
  }
  const fs::path& folder() const { return folder_; }

  Names offers(Names words) const {
    words.insert(words.begin(), "./caplet");
    std::string line =
        "cd '" + folder_.string() +
        "' && bash -c '. ./caplet.bash; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); " +
        "_caplet; printf \"%s\\n\" \"${COMPREPLY[@]}\"' bash";
    for (const std::string& word : words) line += " '" + word + "'";
    FILE* const pipe = ::popen(line.c_str(), "r");
    if (pipe == nullptr) return {"no bash"};
    std::string out;
    for (int c = 0; (c = std::fgetc(pipe)) != EOF;) out += static_cast<char>(c);
    EXPECT_EQ(::pclose(pipe), 0) << line;
    Names lines = test::lines_of(out);
    std::erase(lines, "");
    return lines;
  }

 private:
  const fs::path folder_ = test::folder_with_scene();
};

bool is_installed(const char* tool) {
  return std::system(("command -v " + std::string(tool) + " >/dev/null 2>&1").c_str()) == 0;
}

/// The values that an error lists: "'x' is none of: a, b" or "'x' is no view (a, b, or X,Y,Z ...)".
Names listed_in(const std::string& error) {
  static const std::regex list("'nonsense' is no[^:(]*[:(] ?([^);\n]*)"),
      word("(^|, )([a-z-]+)(?=,|$)");
  std::smatch found;
  Names out;
  if (!std::regex_search(error, found, list)) return out;
  const std::string words = found[1];
  for (std::sregex_iterator i(words.begin(), words.end(), word), end; i != end; ++i)
    out.push_back((*i)[2]);
  return out;
}

/// What a shell command prints, stderr included.
std::string said_by(const std::string& command) {
  FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::string out;
  for (int c = 0; pipe != nullptr && (c = std::fgetc(pipe)) != EOF;) out += static_cast<char>(c);
  if (pipe == nullptr || ::pclose(pipe) != 0) out += "\n(it failed)";
  return out;
}

TEST(Texts, AllCommandsHaveOptions) {
  const auto& all = options_by_command();
  Names names;
  for (const auto& [command, options] : all) names.push_back(command);
  EXPECT_THAT(names, testing::IsSupersetOf({"bench", "convert", "devices", "doctor", "info", "pick",
                                            "render", "verify"}));
  EXPECT_THAT(names, testing::Not(Contains("try-device")));
  EXPECT_THAT(all.at("render"), testing::IsSupersetOf({"-o", "--output", "--style", "--scale-bar",
                                                       "-q", "--layers"}));
  EXPECT_GT(all.at("render").size(), 55U);
}

TEST(Texts, HelpFitsEightyColumns) {
  Names commands{""};
  for (const auto& [command, options] : options_by_command()) commands.push_back(command);
  for (const std::string& command : commands)
    for (const std::string& line :
         test::lines_of(output_of(command.empty() ? Names{"--help"} : Names{command, "--help"})))
      EXPECT_LE(line.size(), 80U) << command << ": " << line;
}

TEST(Texts, HelpHasGroupsDefaultsAndExamples) {
  for (const auto& [command, options] : options_by_command()) {
    const std::string help = output_of({command, "--help"});
    EXPECT_TRUE(has(help, "Examples?:\n  caplet " + command)) << help;
    for (const std::string& option : options)
      EXPECT_TRUE(has(help, "\n  (-., )?" + option + "[ ,\n]")) << option << " of " << command;
  }
  const std::string help = output_of({"render", "--help"});
  Names groups;
  for (const std::string& line : test::lines_of(help))
    if (line.ends_with(':') && !line.starts_with(' ')) groups.push_back(line);
  EXPECT_THAT(groups, testing::IsSupersetOf(
                          {"Output:", "Frames:", "Size and quality:", "Devices:", "The picture:"}));
  EXPECT_THAT(between(help, "--patience", "--stereo"), HasSubstr("(default: 60)"));
  EXPECT_THAT(between(help, "--fps", "--skip-existing"), HasSubstr("(default: 25)"));
  EXPECT_THAT(between(output_of({"verify", "--help"}), "--rays", "--seed"),
              HasSubstr("(default: 1000000)"));
}

// The options in the examples are those of the command.
TEST(Texts, ExamplesAreOfTheCommand) {
  for (const auto& [command, options] : options_by_command()) {
    if (command == "bench") continue;  // hands its arguments on
    for (const std::string& line : test::lines_of(output_of({command, "--help"}))) {
      if (!line.starts_with("  caplet ")) continue;
      static const std::regex option(" (--?[a-z][a-z-]*)");
      for (std::sregex_iterator i(line.begin(), line.end(), option), end; i != end; ++i)
        EXPECT_THAT(options, Contains((*i)[1].str())) << line;
    }
  }
}

TEST(Texts, ManPageHasAllOptions) {
  const std::string page = output_of({"describe", "man"});
  const std::string shared = between(page, ".SH OPTIONS OF SEVERAL COMMANDS", "\n.SH ");
  for (const auto& [command, options] : options_by_command()) {
    std::string upper = command;
    std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
    std::string of_command = between(page, ".SH \"CAPLET " + upper + "\"", "\n.SH ");
    EXPECT_FALSE(of_command.empty()) << command;
    const std::string own = of_command;
    // The groups of several commands name them.
    for (std::size_t at = shared.find(".SS"); at != std::string::npos;
         at = shared.find(".SS", at + 1)) {
      const std::string group = between(shared.substr(at), ".SS", "\n.SS");
      if (between(group, "Of ", "\n").find("\\fB" + command + "\\fR") == std::string::npos)
        continue;
      of_command += group;
      EXPECT_EQ(own.find(group.substr(0, group.find('\n') + 1)), std::string::npos)
          << group << " in " << command;
    }
    for (const std::string& option : options)
      EXPECT_TRUE(of_command.find("\\fB" + in_roff(option) + "\\fR") != std::string::npos)
          << option << " of " << command;
  }
  // Literal values are bold; what stands for a value is in italics.
  EXPECT_THAT(page,
              testing::AllOf(HasSubstr("\\fBfront\\fR|"), HasSubstr("|\\:\\fBorthographic\\fR"),
                             HasSubstr("|\\:\\fIX,Y,Z\\fR")));
}

TEST(Texts, CompletionsHaveAllOptions) {
  const Bash bash;
  const std::string zsh = output_of({"describe", "zsh"}), fish = output_of({"describe", "fish"});
  EXPECT_THAT(between(zsh, "'*.(", ")(-.)'") + "|",
              testing::AllOf(HasSubstr("(pbrt|"), HasSubstr("|swc|")));
  for (const auto& [command, options] : options_by_command()) {
    EXPECT_THAT(bash.offers({command, "-"}), testing::UnorderedElementsAreArray(options))
        << command;
    // No value follows a flag.
    if (std::ranges::find(options, "--quiet") != options.end()) {
      EXPECT_THAT(bash.offers({command, "--quiet", "-"}),
                  testing::UnorderedElementsAreArray(options))
          << command;
    }
    const std::string of_command = between(zsh, "\n    " + command + ")\n", ";;");
    for (const std::string& option : options) {
      EXPECT_TRUE(has(of_command, "[')*]" + option + "[=+]?\\[")) << option << " of " << command;
      const bool is_long = option.starts_with("--");
      EXPECT_TRUE(has(fish, "from " + command + "'[^\n]* -" + (is_long ? "l " : "s ") +
                                option.substr(is_long ? 2 : 1) + " "))
          << option << " of " << command;
    }
  }
}

// zsh offers an option again only where it may be said again: after a star. Others leave with all
// of their names.
TEST(Texts, ZshOffersOptionsAsOftenAsTheyMayBeSaid) {
  const std::string render = between(output_of({"describe", "zsh"}), "\n    render)\n", ";;");
  for (const char* option : {"'*-o+[", "'*--output=[", "'--spp=["})
    EXPECT_THAT(render, HasSubstr(option));
  EXPECT_TRUE(has(render, "'\\((-q --quiet|--quiet -q)\\)--quiet\\["));
}

TEST(Texts, BashCompletesCommandsAndValues) {
  const Bash bash;
  EXPECT_THAT(bash.offers({"rend"}), ElementsAre("render"));
  EXPECT_THAT(bash.offers({"de"}), ElementsAre("devices"));  // what is hidden is not offered
  EXPECT_THAT(bash.offers({"--ver"}), ElementsAre("--version"));
  EXPECT_THAT(bash.offers({"render", "a.pbrt", "--style", ""}),
              UnorderedElementsAre("ball-and-stick", "spheres", "sticks", "trace", "cartoon",
                                   "surface", "accessible"));
  EXPECT_THAT(bash.offers({"render", "--style", "=", "st"}), ElementsAre("sticks"));  // --style=st
  EXPECT_THAT(bash.offers({"render", "--style", "="}), testing::SizeIs(7));
  EXPECT_THAT(bash.offers({"render", "--layers", "al"}), UnorderedElementsAre("all", "albedo"));
  EXPECT_THAT(bash.offers({"render", "--layers", "Z,al"}), ElementsAre("Z,albedo"));
  EXPECT_THAT(bash.offers({"render", "--device", ""}),
              UnorderedElementsAre("all", "cpu", "gpu", "bundled", "0", "1"));
  EXPECT_THAT(bash.offers({"render", "--device", "0,"}), UnorderedElementsAre("0,0", "0,1"));
  EXPECT_THAT(bash.offers({"pick", "--device", ""}),
              UnorderedElementsAre("cpu", "gpu", "bundled", "0", "1"));
  EXPECT_THAT(bash.offers({"render", "--spp", ""}), IsEmpty());
  EXPECT_THAT(bash.offers({"render", "--scale-bar", "--ou"}),
              UnorderedElementsAre("--output", "--outline"));
  EXPECT_THAT(bash.offers({"render", "--scale-bar", "a"}), ElementsAre("auto"));
}

TEST(Texts, BashCompletesFiles) {
  const Bash bash;
  fs::create_directories(bash.folder() / "my scenes");
  for (const char* name : {"my neuron.swc", "mesh.ply.gz", "m.tree", "my notes.txt"})
    test::write_file(bash.folder() / name, "");
  EXPECT_THAT(bash.offers({"render", "m"}),
              UnorderedElementsAre("my neuron.swc", "my scenes", "mesh.ply.gz", "m.tree"));
  EXPECT_THAT(bash.offers({"render", "scene.pbrt", "my n"}), ElementsAre("my neuron.swc"));
  EXPECT_THAT(bash.offers({"render", "--stats", "my"}),
              UnorderedElementsAre("my neuron.swc", "my notes.txt", "my scenes"));
  EXPECT_THAT(bash.offers({"verify", "--save-failures", "m"}), ElementsAre("my scenes"));
  EXPECT_THAT(bash.offers({"devices", "m"}), IsEmpty());
}

// What completions offer is what importers take: their own errors list it.
TEST(Texts, ValuesAreThoseOfTheImporters) {
  const Bash bash;
  test::write_file(bash.folder() / "molecule.xyz", "1\n\nH 0 0 0\n");
  test::write_file(bash.folder() / "molecule.pdb",
                   "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  5.00           "
                   "C\n");
  test::write_file(bash.folder() / "neuron.swc", "1 1 0 0 0 1 -1\n");
  test::write_file(
      bash.folder() / "robot.urdf",
      "<robot name='r'><link name='l'><visual><geometry><sphere radius='1'/></geometry></visual>"
      "<collision><geometry><sphere radius='1'/></geometry></collision></link></robot>");
  const std::multimap<std::string, std::string> files = {
      {"style", "molecule.xyz"}, {"hydrogens", "molecule.xyz"}, {"view", "neuron.swc"},
      {"up", "neuron.swc"},      {"projection", "neuron.swc"},  {"light", "neuron.swc"},
      {"groups", "robot.urdf"},  {"secondary", "molecule.pdb"}};
  for (const auto& [option, file] : files) {
    const test::Result refused =
        test::run_program({"info", file, "--" + option + "=nonsense"}, bash.folder());
    EXPECT_EQ(refused.code, 2) << option;
    const Names offered = bash.offers({"info", file, "--" + option, ""});
    EXPECT_THAT(offered, testing::UnorderedElementsAreArray(listed_in(refused.err)))
        << option << ": " << refused.err;
    for (const std::string& value : offered) {
      const test::Result taken =
          test::run_program({"info", file, "--" + option + "=" + value}, bash.folder());
      EXPECT_THAT(taken.err, testing::Not(HasSubstr("'" + value + "' is no"))) << option;
    }
  }
  EXPECT_THAT(
      test::run_program({"info", "molecule.pdb"}, bash.folder()).out,
      HasSubstr("atoms        1\nresidues     1\nchains       1\nligands      0\nmodels       "
                "1\n"));
  for (const char* color : {"element", "chain", "residue", "bfactor", "secondary"})
    EXPECT_THAT(test::run_program({"info", "molecule.xyz", "--color", color}, bash.folder()).err,
                testing::Not(HasSubstr("is none of")))
        << color;
  EXPECT_THAT(bash.offers({"info", "--color", "b"}), ElementsAre("bfactor"));
  for (const std::string& background : bash.offers({"info", "--background", ""}))
    if (!fs::exists(bash.folder() / background)) {
      EXPECT_EQ(
          test::run_program({"info", "neuron.swc", "--background", background}, bash.folder()).code,
          0)
          << background;
    }
}

TEST(Texts, ManPageHasNoWarnings) {
  const fs::path folder = test::folder_with_scene();
  test::write_file(folder / "caplet.1", output_of({"describe", "man"}));
  if (!is_installed("groff") && !is_installed("man"))
    GTEST_SKIP() << "neither groff nor man is installed";
  const std::string file = "'" + (folder / "caplet.1").string() + "'";
  if (is_installed("groff")) {
    EXPECT_EQ(said_by("groff -ww -man -Tutf8 -z " + file), "");
  }
  if (is_installed("man")) {
    EXPECT_EQ(
        said_by("LC_ALL=C.UTF-8 MANROFFSEQ= MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z " +
                file + " 2>&1 >/dev/null"),
        "");
  }
}

TEST(Texts, ShellsTakeTheirCompletions) {
  const fs::path folder = test::folder_with_scene();
  std::string missing;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    test::write_file(folder / shell, output_of({"describe", shell}));
    if (is_installed(shell))
      EXPECT_EQ(said_by(std::string(shell) + " -n '" + (folder / shell).string() + "'"), "")
          << shell;
    else
      missing += std::string(" ") + shell;
  }
  if (!missing.empty()) GTEST_SKIP() << "not installed:" << missing;
}

TEST(Texts, UnknownTextsAreRefused) {
  const test::Result result = test::run_program({"describe", "tcsh"}, test::folder_with_scene());
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("'tcsh' is none of man, bash, zsh, fish"));
}

TEST(Texts, EnvironmentVariablesAreListed) {
  const auto text_of = [](const fs::path& file) {
    std::ifstream in(file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  std::set<std::string> read;
  static const std::regex variable("\"(CAPLET_[A-Z_]*[A-Z])\"");
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(test::source_folder() / "host")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator i(text.begin(), text.end(), variable), end; i != end; ++i)
      read.insert((*i)[1]);
  }
  // These are what the program tells its second process.
  read.erase("CAPLET_DRIVER_CACHE");
  read.erase("CAPLET_DRIVER_FAILED");
  EXPECT_THAT(read, Contains("CAPLET_CACHE"));
  const std::string listed = between(text_of(test::source_folder() / "docs/cli.md"),
                                     "\n## Environment variables\n", "\n## ");
  for (const std::string& name : read) EXPECT_THAT(listed, HasSubstr("`" + name + "`"));
}

}  // namespace
}  // namespace caplet
