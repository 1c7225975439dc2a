// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/import_options.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "import/detail/text_file.h"

namespace caplet {

const std::vector<ImportOptionRow>& import_option_rows() {
  static const std::vector<ImportOptionRow> rows = {
#define IMPORT_OPTION(name, values, help) {name, values, help, ImportOptionRow::Of::format},
#define PICTURE_OPTION(name, values, help) {name, values, help, ImportOptionRow::Of::picture},
#define READING_OPTION(name, values, help) {name, values, help, ImportOptionRow::Of::reading},
#include "import/import_options.def"
#undef IMPORT_OPTION
#undef PICTURE_OPTION
#undef READING_OPTION
  };
  return rows;
}

void ValueRange::extend(double value) {
  low = is_there ? std::min(low, value) : value;
  high = is_there ? std::max(high, value) : value;
  is_there = true;
}

std::optional<std::string> ImportOptions::text(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? std::nullopt : std::optional(found->second);
}

std::size_t ImportOptions::choice(const std::string& name, std::initializer_list<const char*> choices,
                                  std::size_t otherwise) const {
  const std::optional<std::string> asked = text(name);
  if (!asked) return otherwise;
  std::string known;
  std::size_t i = 0;
  for (const char* choice : choices) {
    if (*asked == choice) return i;
    known += (known.empty() ? "" : ", ") + std::string(choice);
    ++i;
  }
  throw InputError({"--" + name}, "'" + *asked + "' is none of: " + known);
}

bool ImportOptions::yes(const std::string& name, bool otherwise) const {
  return choice(name, {"no", "yes"}, otherwise ? 1 : 0) == 1;
}

std::optional<std::pair<double, double>> ImportOptions::range(const std::string& name) const {
  const std::optional<std::string> asked = text(name);
  if (!asked) return std::nullopt;
  const std::string_view whole = *asked;
  const std::size_t comma = std::min(whole.find(','), whole.size());
  std::pair<double, double> out;
  if (comma == whole.size() || !parse_number(whole.substr(0, comma), out.first) ||
      !parse_number(whole.substr(comma + 1), out.second) || !std::isfinite(out.first) || !std::isfinite(out.second) ||
      !(out.first < out.second))
    throw InputError({"--" + name}, "'" + *asked + "' is not LOW,HIGH: two numbers, the second above the first");
  return out;
}

std::uint32_t ImportOptions::number(const std::string& name, std::uint32_t otherwise) const {
  const std::optional<std::string> asked = text(name);
  if (!asked) return otherwise;
  std::uint32_t value = 0;
  if (!parse_number(std::string_view(*asked), value) || value == 0)
    throw InputError({"--" + name}, "'" + *asked + "' is no whole number from 1");
  return value;
}

}  // namespace caplet
