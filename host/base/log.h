// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Diagnostics go to stderr, one line each; results never do. Levels: quiet shows warnings and errors only.
#pragma once

#include <spdlog/spdlog.h>

namespace caplet::log {

void set_quiet(bool quiet);
/// Number of errors logged since the start; tests fail when it moved unexpectedly.
int error_count();

using spdlog::debug;
using spdlog::error;
using spdlog::info;
using spdlog::warn;

}  // namespace caplet::log
