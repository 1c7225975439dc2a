// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Sets of options that make a kind of picture.
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace caplet::cli {

/// Adds `--preset`, which stores a name.
void add_preset(CLI::App& command, std::string& name);

/// Gives the options of a preset to the command where the user has not given them. Throws
/// InputError that names --preset, or the option that refuses its value.
void apply_preset(CLI::App& command, const std::string& name);

}  // namespace caplet::cli
