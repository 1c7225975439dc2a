// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/overlays.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "table/ray_file.h"

namespace caplet::cli {

namespace {

/// The number after a flag, if there is one. Throws InputError naming the flag.
double number_or(const std::vector<std::string>& given, double usual, double low, double high, const char* flag) {
  if (given.empty() || given[0].empty()) return usual;
  double value = 0;
  if (parse_number(given[0], value) || !(value >= low && value <= high))
    throw InputError(SourceLocation{flag}, fmt::format("'{}' is no number from {} to {}", given[0], low, high));
  return value;
}

}  // namespace

void add_overlays(CLI::App& command, post::Overlays& overlays) {
  constexpr const char* group = "Drawn on the preview";
  command
      .add_option_function<std::vector<std::string>>(
          "--scale-bar",
          [&overlays](const std::vector<std::string>& given) {
            overlays.scale_bar = post::parse_scale_bar(given.empty() || given[0] == "auto" ? "" : given[0], "--scale-bar");
          },
          "A scale bar: auto, or its length, such as \"50 um\"; true everywhere in orthographic pictures, in others at the "
          "middle")
      ->expected(0, 1)
      ->type_name("LENGTH")
      ->group(group);
  command
      .add_option_function<std::vector<std::string>>(
          "--outline",
          [&overlays](const std::vector<std::string>& given) { overlays.outline = number_or(given, 1.5, 0.1, 64, "--outline"); },
          "Black lines around objects and where one part stands before another; their width (1.5)")
      ->expected(0, 1)
      ->type_name("PIXELS")
      ->group(group);
  command
      .add_option_function<std::vector<std::string>>(
          "--depth-cue",
          [&overlays](const std::vector<std::string>& given) { overlays.depth_cue = number_or(given, 0.6, 0, 1, "--depth-cue"); },
          "What is further fades into the background; by how much the farthest (0.6)")
      ->expected(0, 1)
      ->type_name("SHARE")
      ->group(group);
  command.add_flag("--axes", overlays.axes, "The file's axes, x red, y green, z blue")->group(group);
  command.add_flag("--color-bar", overlays.color_bar, "What the colours tell, where they tell a number")->group(group);
}

}  // namespace caplet::cli
