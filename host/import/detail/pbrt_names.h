// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What pbrt-v4 knows by name, and which of it is rendered: the tables behind docs/formats/pbrt.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace caplet::pbrt {

struct NameTable {
  std::string directive;              // "Material"
  std::vector<std::string> accepted;  // rendered
  std::vector<std::string> refused;   // known, not rendered yet
};

/// One row a directive that takes a type name.
const std::vector<NameTable>& name_tables();

/// Whether a type of Shape is a file of another format.
bool is_file_shape(std::string_view type);

/// All directives.
const std::vector<std::string>& directive_names();

/// Whether pbrt-v4, or Caplet, has this type of `directive`.
bool is_known_name(std::string_view directive, const std::string& name);

/// Why a type of `directive` cannot be used, and what groups such errors; `text` is empty where it is accepted.
struct Refusal {
  std::string text;
  bool is_known = true;  // to pbrt-v4: not rendered yet
};
Refusal refusal_of(std::string_view directive, const std::string& name);

/// True if `name` is accepted; otherwise reports that it is unknown, or known and not rendered yet.
bool check_name(std::string_view directive, const std::string& name, const SourceLocation& where, Diagnostics& diagnostics);

}  // namespace caplet::pbrt
