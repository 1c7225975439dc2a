// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/overlays.h"

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "post/overlay_options.h"

namespace caplet::cli {

void add_overlays(CLI::App& command, post::Overlays& overlays) {
  constexpr const char* group = "Drawn on the preview";
  for (const post::OverlayRow& row : post::overlay_rows()) {
    const std::string name = row.name, flag = "--" + name;
    if (row.values.empty()) {
      command
          .add_flag_callback(
              flag, [&overlays, name, flag] { post::set_overlay(overlays, name, "", flag); },
              row.help)
          ->group(group);
      continue;
    }
    if (row.is_list) {
      command
          .add_option_function<std::string>(
              flag,
              [&overlays, name, flag](const std::string& given) {
                post::set_overlay(overlays, name, given, flag);
              },
              row.help)
          ->multi_option_policy(CLI::MultiOptionPolicy::Join)
          ->type_name(row.values)
          ->group(group);
      continue;
    }
    command
        .add_option_function<std::vector<std::string>>(
            flag,
            [&overlays, name, flag](const std::vector<std::string>& given) {
              post::set_overlay(overlays, name, given.empty() ? "" : given[0], flag);
            },
            row.help)
        ->expected(0, 1)
        ->type_name(row.values)
        ->group(group);
  }
}

}  // namespace caplet::cli
