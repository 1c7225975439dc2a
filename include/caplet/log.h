// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Messages of the library: warnings, and at `info` long operations.
#pragma once

#include <functional>
#include <string_view>

#include "caplet/export.h"

namespace caplet {

enum class LogLevel { info, warning, error, none };

/// Receives one message without line break. It is called from any thread, one call at a time, and
/// may not call the library.
using LogSink = std::function<void(LogLevel level, std::string_view message)>;

/// Sets the receiver of messages for the whole process; empty: stderr, as "caplet: warning:
/// message".
CAPLET_API void set_log_sink(LogSink sink);
/// Sets the lowest level that is logged; the default is `warning`.
CAPLET_API void set_log_level(LogLevel least);

}  // namespace caplet
