// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/all_rows.h"

#include <fmt/format.h>

#include <string>

#include "base/environment.h"
#include "base/error.h"

namespace caplet {

bool for_all_rows() {
  const char* const variable = "CAPLET_ROWS";
  const std::string text = environment_variable(variable);
  if (!text.empty() && text != "all" && text != "scene")
    throw InputError(SourceLocation{variable}, fmt::format("'{}' is not all or scene", text));
  return text == "all";
}

}  // namespace caplet
