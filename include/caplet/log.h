// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the library says beside its results: warnings, and at `info` what takes long.
#pragma once

#include <functional>
#include <string_view>

#include "caplet/export.h"

namespace caplet {

enum class LogLevel { info, warning, error, none };

/// One message without line break; from any thread, one at a time. It may not call the library.
using LogSink = std::function<void(LogLevel level, std::string_view message)>;

/// Where messages go, for the whole process; empty: to stderr, as "caplet: warning: message".
CAPLET_API void set_log_sink(LogSink sink);
/// The least that is said; `warning` unless set.
CAPLET_API void set_log_level(LogLevel least);

}  // namespace caplet
