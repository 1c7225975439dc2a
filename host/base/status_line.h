// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <string_view>

namespace caplet::log {

/// Shows `text` on the terminal's last line until it is replaced; messages stand above it. Empty:
/// the line is gone.
void show_line(std::string_view text);

}  // namespace caplet::log
