// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The kernel files as they were at build; the table itself is generated (embed_main.cpp).
#pragma once

#include <span>
#include <string_view>

namespace caplet {

struct EmbeddedFile {
  std::string_view path;  // from kernels/, as #include names it
  std::string_view text;
};

std::span<const EmbeddedFile> embedded_kernels();

}  // namespace caplet
