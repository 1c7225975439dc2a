// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/spelling.h"

namespace caplet::cli {

namespace {

struct Preset {
  const char* name;
  std::vector<std::pair<const char*, const char*>> options;
};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> rows = {
      {"soft",
       {{"--light", "flat"},
        {"--background", "white"},
        {"--outline", "1.5"},
        {"--depth-cue", "0.4"}}},
      {"illustration", {{"--light", "flat"}, {"--background", "white"}, {"--outline", "2.5"}}},
      {"paper",
       {{"--background", "white"},
        {"--projection", "orthographic"},
        {"--outline", "1"},
        {"--scale-bar", "auto"}}},
      {"dark", {{"--light", "dramatic"}, {"--background", "black"}}},
  };
  return rows;
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const Preset& preset : presets()) out.emplace_back(preset.name);
  return out;
}

}  // namespace

void add_preset(CLI::App& command, std::string& name) {
  std::string help = "Sets what is not given:";
  for (const Preset& preset : presets()) {
    help += fmt::format("{} {}:", &preset == presets().data() ? "" : ";", preset.name);
    for (const auto& [option, value] : preset.options) help += fmt::format(" {} {}", option, value);
  }
  command.add_option("--preset", name, help)
      ->type_name(fmt::format("{}", fmt::join(names(), "|")))
      ->group("The picture");
}

void apply_preset(CLI::App& command, const std::string& name) {
  if (name.empty()) return;
  for (const Preset& preset : presets()) {
    if (name != preset.name) continue;
    for (const auto& [option, value] : preset.options) {
      CLI::Option* const one = command.get_option(option);
      if (one->count() > 0) continue;
      one->add_result(value);
      one->run_callback();
    }
    return;
  }
  throw InputError(SourceLocation{"--preset"}, none_of(name, names()));
}

}  // namespace caplet::cli
