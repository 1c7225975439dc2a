// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "library/detail/statements.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/error.h"

namespace caplet::v0 {

namespace {

/// Converts one parameter: of its values, `count` from `first` on, or all where `count` is 0.
struct ToStatement {
  StatementParameter& out;
  std::size_t first = 0, count = 0;

  template <class T>
  std::vector<T> cut(const std::vector<T>& values) const {
    if (count == 0) return values;
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
  }
  void operator()(double value) const { out.numbers = {value}; }
  void operator()(const Rgb& value) const {
    out.type = "rgb";
    out.numbers = {value.r, value.g, value.b};
  }
  void operator()(const std::string& value) const { out.strings = {value}; }
  void operator()(bool value) const { out.bools = {value}; }
  void operator()(const TextureNumber& value) const {
    out.type = "texture";
    out.strings = {std::to_string(value.number)};
  }
  void operator()(const std::array<double, 3>& value) const {
    out.numbers = {value.begin(), value.end()};
  }
  void operator()(const std::array<std::uint32_t, 2>& value) const {
    out.numbers = {value.begin(), value.end()};
  }
  void operator()(const Blackbody& value) const {
    out.type = "blackbody";
    out.numbers = {value.kelvin};
  }
  void operator()(const std::vector<double>& values) const { out.numbers = cut(values); }
  void operator()(const std::vector<std::string>& values) const { out.strings = cut(values); }
  void operator()(const std::shared_ptr<const Pixels>&) const {
    throw InputError(fmt::format("'{}' is an image, which textures alone have", out.name));
  }
};

}  // namespace

void put_values(const std::string& owner, const Parameter& parameter, StatementParameter& out,
                std::size_t first, std::size_t count) {
  std::visit(ToStatement{out, first, count}, parameter);
  for (const double value : out.numbers)
    if (!std::isfinite(value))
      throw InputError(fmt::format("{}: '{}' is not finite", owner, out.name));
}

ProgramStatement to_statement(const std::string& directive, const std::string& type,
                              const Parameters& parameters) {
  ProgramStatement out{directive, type};
  for (const auto& [name, value] : parameters) {
    StatementParameter& one = out.parameters.emplace_back();
    one.name = name;
    put_values(type, value, one);
  }
  return out;
}

}  // namespace caplet::v0
