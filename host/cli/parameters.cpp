// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/spelling.h"
#include "import/statement.h"
#include "report/summary.h"

namespace caplet::cli {

namespace {

using Json = nlohmann::ordered_json;

void check_name(const std::string& name, const std::vector<std::string>& known,
                const std::string& what) {
  if (std::ranges::find(known, name) == known.end())
    throw InputError(fmt::format("--parameters: there is no {} '{}'; the nearest is '{}'", what,
                                 name, nearest_name(name, known)));
}

/// Returns the requested types: (family, type).
std::vector<std::pair<std::string, std::string>> types_of(const std::vector<std::string>& names) {
  if (names.size() > 2) throw InputError("--parameters takes a family and a type, not more");
  std::vector<std::pair<std::string, std::string>> out;
  if (!names.empty()) check_name(names[0], schema::families(), "family");
  for (const std::string& family : schema::families()) {
    if (!names.empty() && family != names[0]) continue;
    const std::vector<std::string> types = file_statement_types(schema::directive_of(family));
    if (names.size() == 2) check_name(names[1], types, family);
    for (const std::string& type : types)
      if (names.size() < 2 || type == names[1]) out.emplace_back(family, type);
  }
  return out;
}

std::string range_text(const schema::Parameter& parameter) {
  const bool has_low = std::isfinite(parameter.low), has_high = std::isfinite(parameter.high);
  const std::string low =
      fmt::format("{} {}", parameter.above_low ? "above" : "from", parameter.low);
  if (has_low && has_high) return fmt::format("{} to {}", low, parameter.high);
  return has_low    ? low + (parameter.above_low ? "" : " up")
         : has_high ? fmt::format("up to {}", parameter.high)
                    : "";
}

std::string line_of(const schema::Parameter& parameter, std::size_t width) {
  std::string out =
      fmt::format("  {:<{}}  {}", parameter.name, width, fmt::join(parameter.types, "|"));
  if (!parameter.fallback.empty()) out += ", default " + parameter.fallback;
  if (const std::string range = range_text(parameter); !range.empty()) out += ", " + range;
  if (!parameter.unit.empty()) out += " " + parameter.unit;
  out += ": " + parameter.doc;
  if (!parameter.choices.empty()) out += fmt::format(" ({})", fmt::join(parameter.choices, ", "));
  if (!parameter.has_effect) out += " (read and ignored)";
  return out + "\n";
}

Json json_of(const schema::Parameter& parameter) {
  Json out{{"name", parameter.name}, {"types", parameter.types}, {"doc", parameter.doc}};
  if (!parameter.fallback.empty()) out["default"] = parameter.fallback;
  if (std::isfinite(parameter.low)) out[parameter.above_low ? "above" : "low"] = parameter.low;
  if (std::isfinite(parameter.high)) out["high"] = parameter.high;
  if (!parameter.unit.empty()) out["unit"] = parameter.unit;
  if (!parameter.choices.empty()) out["choices"] = parameter.choices;
  if (!parameter.excludes.empty()) out["excludes"] = parameter.excludes;
  out["has_effect"] = parameter.has_effect;
  return out;
}

}  // namespace

std::string parameters_text(const std::vector<std::string>& names) {
  std::string out;
  if (names.empty()) {
    for (const std::string& family : schema::families())
      out += fmt::format("{:<11} {}\n", family,
                         fmt::join(file_statement_types(schema::directive_of(family)), " "));
    return out;
  }
  for (const auto& [family, type] : types_of(names)) {
    const auto parameters = schema::parameters_of(schema::directive_of(family), type);
    std::size_t width = 0;
    for (const schema::Parameter& one : parameters) width = std::max(width, one.name.size());
    out += fmt::format("{}{} {}\n", out.empty() ? "" : "\n", schema::directive_of(family), type);
    for (const schema::Parameter& one : parameters) out += line_of(one, width);
  }
  return out;
}

std::string parameters_json(const std::vector<std::string>& names) {
  Json out = Json::array();
  for (const auto& [family, type] : types_of(names)) {
    Json parameters = Json::array();
    for (const schema::Parameter& one : schema::parameters_of(schema::directive_of(family), type))
      parameters.push_back(json_of(one));
    out.push_back({{"family", family},
                   {"directive", schema::directive_of(family)},
                   {"type", type},
                   {"parameters", std::move(parameters)}});
  }
  return report::to_text(out);
}

}  // namespace caplet::cli
