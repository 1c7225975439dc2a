// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file makes the messages for wrong command lines.
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace caplet::cli {

/// Returns the message for an error of parsing: CLI11's own, but for unknown commands, options and
/// arguments, which are named with the nearest that there is.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace caplet::cli
