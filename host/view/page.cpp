// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/page.h"

#include <array>
#include <utility>

#include "base/embedded_file.h"

namespace caplet {
std::span<const EmbeddedFile> embedded_page();  // generated
}

namespace caplet::view {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> types{
    {{".html", "text/html; charset=utf-8"},
     {".css", "text/css; charset=utf-8"},
     {".js", "text/javascript; charset=utf-8"},
     {".svg", "image/svg+xml"}}};

}  // namespace

std::optional<PageFile> page_file(std::string_view name) {
  if (name.empty()) name = "index.html";
  for (const EmbeddedFile& file : embedded_page()) {
    if (file.path != name) continue;
    for (const auto& [ending, type] : types)
      if (name.ends_with(ending)) return PageFile{type, file.text};
  }
  return {};
}

}  // namespace caplet::view
