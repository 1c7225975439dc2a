// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The files of the page (host/view/page), which are part of the program.
#pragma once

#include <optional>
#include <string_view>

#include "view/server.h"

namespace caplet::view {

/// The file of that name; "" is index.html.
std::optional<PageFile> page_file(std::string_view name);

}  // namespace caplet::view
