// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The names of pbrt-v4, and which of them are supported: the tables behind docs/formats/pbrt.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace caplet::pbrt {

struct NameTable {
  std::string directive;              // "Material"
  std::vector<std::string> accepted;  // supported
  std::vector<std::string> refused;   // known but not supported yet
};

/// Returns one row per directive that takes a type name.
const std::vector<NameTable>& name_tables();

/// Returns whether a type of Shape is a file of another format.
bool is_file_shape(std::string_view type);

/// Lists all directives.
const std::vector<std::string>& directive_names();

/// Returns whether pbrt-v4 or Caplet has this type of `directive`.
bool is_known_name(std::string_view directive, const std::string& name);

/// Says why a type of `directive` cannot be used, and how such errors are grouped; `text` is empty
/// where it is accepted.
struct Refusal {
  std::string text;
  bool is_known = true;  // pbrt-v4 knows it, but it is not supported yet
};
Refusal refusal_of(std::string_view directive, const std::string& name);

/// True if `name` is accepted; otherwise reports that it is unknown, or known and not rendered yet.
bool check_name(std::string_view directive, const std::string& name, const SourceLocation& where,
                Diagnostics& diagnostics);

}  // namespace caplet::pbrt
