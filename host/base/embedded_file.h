// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files that are embedded in the program; the build makes tables of them
// (host/base/embed_main.cpp).
#pragma once

#include <span>
#include <string_view>

namespace caplet {

struct EmbeddedFile {
  std::string_view path;  // relative to their common folder
  std::string_view text;
};

}  // namespace caplet
