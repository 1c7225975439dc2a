// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files that are part of the program, in tables that are made at build (host/base/embed_main.cpp).
#pragma once

#include <span>
#include <string_view>

namespace caplet {

struct EmbeddedFile {
  std::string_view path;  // from the folder of all of them
  std::string_view text;
};

}  // namespace caplet
