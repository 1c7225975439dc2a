// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/import_options.h"

#include "base/error.h"
#include "import/detail/text_file.h"

namespace caplet {

const std::vector<ImportOptionRow>& import_option_rows() {
  static const std::vector<ImportOptionRow> rows = {
#define IMPORT_OPTION(name, values, help) {name, values, help, false},
#define LOOK_OPTION(name, values, help) {name, values, help, true},
#include "import/import_options.def"
#undef IMPORT_OPTION
#undef LOOK_OPTION
  };
  return rows;
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

std::uint32_t ImportOptions::number(const std::string& name, std::uint32_t otherwise) const {
  const std::optional<std::string> asked = text(name);
  if (!asked) return otherwise;
  std::uint32_t value = 0;
  if (!parse_number(std::string_view(*asked), value) || value == 0)
    throw InputError({"--" + name}, "'" + *asked + "' is no whole number from 1");
  return value;
}

}  // namespace caplet
