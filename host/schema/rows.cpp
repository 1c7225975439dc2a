// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "schema/detail/rows.h"

#include <algorithm>
#include <utility>

#include "schema/detail/describe.h"

namespace caplet::schema {

Parameter parameter_of(const Row& row) {
  std::vector<Parameter> out;
  add_rows({&row, 1}, out);
  return out.front();
}

void add_rows(std::span<const Row> rows, std::vector<Parameter>& out) {
  for (const Row& row : rows) {
    std::vector<std::string> types;
    for (std::string_view rest = row.types; !rest.empty();) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      types.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    Describe(out).add(row.field, std::move(types), row.fallback);
  }
}

void add_ignored(std::span<const Row> rows, std::vector<Parameter>& out) {
  const std::size_t before = out.size();
  add_rows(rows, out);
  for (std::size_t i = before; i < out.size(); ++i) out[i].has_effect = false;
}

}  // namespace caplet::schema
