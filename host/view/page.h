// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The page's files (host/view/page), which are embedded in the program.
#pragma once

#include <optional>
#include <string_view>

#include "view/server.h"

namespace caplet::view {

/// Returns the file of that name; "" is index.html.
std::optional<PageFile> page_file(std::string_view name);

}  // namespace caplet::view
