// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/parameter.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/spelling.h"
#include "import/detail/pbrt/v3.h"

namespace caplet::pbrt {

namespace {

struct TypeRow {
  std::string_view name, canonical;
  std::size_t multiple;  // of which the number of values is a multiple
  bool single;           // there is exactly that number
};

const std::vector<TypeRow>& type_rows() {
  static const std::vector<TypeRow> rows = {
      {"integer", "integer", 1, false},    {"float", "float", 1, false},
      {"bool", "bool", 1, false},          {"string", "string", 1, false},
      {"point2", "point2", 2, false},      {"vector2", "vector2", 2, false},
      {"point3", "point3", 3, false},      {"point", "point3", 3, false},
      {"vector3", "vector3", 3, false},    {"vector", "vector3", 3, false},
      {"normal", "normal", 3, false},      {"normal3", "normal", 3, false},
      {"spectrum", "spectrum", 1, false},  {"rgb", "rgb", 3, false},
      {"blackbody", "blackbody", 1, true}, {"texture", "texture", 1, true}};
  return rows;
}

const TypeRow* find_type(std::string_view name) {
  for (const TypeRow& row : type_rows())
    if (row.name == name) return &row;
  return nullptr;
}

std::string unknown_type(std::string_view type) {
  const std::string unknown = "unknown parameter type " + in_quotes(type);
  if (const std::string old = v3_name("type", type); !old.empty())
    return unknown + ": that is " + old;
  std::vector<std::string> known;
  for (const TypeRow& row : type_rows()) known.emplace_back(row.name);
  return unknown + "; the nearest known type is \"" + nearest_name(type, known) + "\"";
}

/// Splits "type name"; both are empty when it is not two words.
std::pair<std::string_view, std::string_view> split_declaration(std::string_view text) {
  constexpr std::string_view blanks = " \t\n\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin);
  text = text.substr(0, text.find_last_not_of(blanks) + 1);
  const std::size_t gap = text.find_first_of(blanks);
  if (gap == std::string_view::npos) return {};
  const std::string_view name = text.substr(text.find_first_not_of(blanks, gap));
  if (name.find_first_of(blanks) != std::string_view::npos) return {};
  return {text.substr(0, gap), name};
}

void add_value(Parameter& parameter, const Token& token, const Lexer& lexer) {
  const bool is_string = token.kind == Token::Kind::string;
  if (parameter.type == "bool") {
    if (token.text != "true" && token.text != "false")
      throw SyntaxError{lexer.place(token),
                        "expected true or false, found " + in_quotes(token.text)};
    parameter.bools.push_back(token.text == "true");
  } else if (parameter.type == "string" || parameter.type == "texture" ||
             (parameter.type == "spectrum" && is_string)) {
    if (!is_string)
      throw SyntaxError{lexer.place(token),
                        "expected a quoted string, found " + in_quotes(token.text)};
    parameter.strings.emplace_back(token.text);
  } else if (parameter.type == "integer") {
    if (is_string)
      throw SyntaxError{lexer.place(token),
                        "expected an integer, found the string " + in_quotes(token.text)};
    parameter.numbers.push_back(parse_integer(token, lexer.file()));
  } else {
    if (is_string)
      throw SyntaxError{lexer.place(token),
                        "expected a number, found the string " + in_quotes(token.text)};
    parameter.numbers.push_back(parse_number(token, lexer.file()));
  }
}

void skip_values(Lexer& lexer) {
  if (lexer.peek().kind == Token::Kind::close) lexer.next();
  if (lexer.peek().kind != Token::Kind::open) return;
  while (lexer.peek().kind != Token::Kind::close && lexer.peek().kind != Token::Kind::end)
    lexer.next();
  if (lexer.peek().kind == Token::Kind::close) lexer.next();
}

bool takes_numbers(const std::string& type) {
  return type != "bool" && type != "string" && type != "texture" && type != "spectrum";
}

/// Parses the values after a declaration. The first wrong value is kept in `problem`, and the rest
/// is skipped.
void parse_values(Parameter& parameter, Lexer& lexer, std::optional<SyntaxError>& problem) {
  const auto add = [&](const Token& token) {
    if (problem) return;
    try {
      add_value(parameter, token, lexer);
    } catch (const SyntaxError& error) {
      problem = error;
    }
  };
  if (lexer.peek().kind != Token::Kind::open) {
    if (lexer.peek().kind != Token::Kind::word && lexer.peek().kind != Token::Kind::string)
      throw SyntaxError{
          lexer.place(lexer.peek()),
          "the parameter " + in_quotes(parameter.type + " " + parameter.name) + " has no value"};
    add(lexer.next());
    return;
  }
  const Token open = lexer.next();
  if (takes_numbers(parameter.type))
    lexer.take_numbers(parameter.numbers, parameter.type == "integer");
  while (lexer.peek().kind != Token::Kind::close) {
    if (lexer.peek().kind == Token::Kind::end)
      throw SyntaxError{lexer.place(open), "this bracket is never closed"};
    if (lexer.peek().kind == Token::Kind::open)
      throw SyntaxError{lexer.place(lexer.peek()), "a bracket within brackets"};
    add(lexer.next());
  }
  lexer.next();
}

/// Finds a parameter by its name: by linear search among few, by a table among many.
class GivenNames {
 public:
  Parameter* find(std::vector<Parameter>& parameters, const std::string& name) {
    constexpr std::size_t few = 32;
    const std::size_t count = parameters.size();
    for (std::size_t i = 0; i < std::min(count, few); ++i)
      if (parameters[i].name == name) return &parameters[i];
    for (std::size_t i = few + table_.size(); i < count; ++i) table_.emplace(parameters[i].name, i);
    const auto found = table_.find(name);
    return found == table_.end() ? nullptr : &parameters[found->second];
  }

 private:
  std::unordered_map<std::string, std::size_t> table_;
};

/// Returns the lexer at the next parameter, or null. A statement at the end of an included file
/// continues after the Include, as in pbrt-v4.
Lexer* at_parameter(Lexer& lexer) {
  Lexer* at = &lexer;
  while (at && at->peek().kind == Token::Kind::end) at = at->behind();
  return at && at->peek().kind == Token::Kind::string ? at : nullptr;
}

std::string plural(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " value" : " values");
}

/// Returns the error in a parameter's number of values; empty when it is right.
std::string check_count(const Parameter& parameter, const TypeRow& row) {
  const std::size_t count =
      parameter.numbers.size() + parameter.strings.size() + parameter.bools.size();
  const std::string name = in_quotes(parameter.type + " " + parameter.name);
  if (count == 0) return "the parameter " + name + " has no value";
  if (parameter.type == "spectrum") {
    if (!parameter.strings.empty() && !parameter.numbers.empty())
      return name + " mixes names and numbers";
    if (parameter.strings.size() > 1)
      return name + " takes one name or file, not " + std::to_string(parameter.strings.size());
    if (parameter.numbers.size() % 2)
      return name + " takes pairs of wavelength and value, not " + plural(count);
    for (std::size_t i = 2; i < parameter.numbers.size(); i += 2)
      if (parameter.numbers[i] <= parameter.numbers[i - 2])
        return name + ": wavelengths must ascend";
    return {};
  }
  if (row.single && count != row.multiple)
    return name + " takes " + plural(row.multiple) + ", not " + std::to_string(count);
  if (count % row.multiple)
    return name + " takes a multiple of " + plural(row.multiple) + ", not " + std::to_string(count);
  return {};
}

}  // namespace

std::size_t values_each(std::string_view type) { return find_type(type)->multiple; }

std::vector<Parameter> parse_parameters(Lexer& statement, Diagnostics& diagnostics) {
  std::vector<Parameter> parameters;
  GivenNames given;
  while (Lexer* const at = at_parameter(statement)) {
    Lexer& lexer = *at;
    const Token declaration = lexer.next();
    Parameter parameter;
    parameter.where = lexer.place(declaration);
    const auto [type, name] = split_declaration(declaration.text);
    const TypeRow* row = find_type(type);
    if (type.empty() || !row) {
      if (type.empty())
        diagnostics.error(parameter.where, "expected a parameter (\"type name\"), found " +
                                               in_quotes(declaration.text));
      else
        diagnostics.error(parameter.where, unknown_type(type),
                          "parameter type " + std::string(type));
      if (lexer.peek().kind == Token::Kind::open || type.empty())
        skip_values(lexer);
      else if (lexer.peek().kind == Token::Kind::word || lexer.peek().kind == Token::Kind::string)
        lexer.next();
      continue;
    }
    parameter.type = row->canonical;
    parameter.name = name;
    std::optional<SyntaxError> problem;
    parse_values(parameter, lexer, problem);
    if (problem) {
      diagnostics.error(problem->where,
                        in_quotes(parameter.type + " " + parameter.name) + ": " + problem->message);
      parameter.broken = true;
    } else if (const std::string complaint = check_count(parameter, *row); !complaint.empty()) {
      diagnostics.error(parameter.where, complaint);
      parameter.broken = true;
    }
    if (Parameter* first = given.find(parameters, parameter.name)) {
      const std::string twice = "the parameter " + in_quotes(parameter.name) +
                                " is given twice (first at " + first->where.to_string() + ")";
      if (first->type != parameter.type) {
        diagnostics.error(parameter.where,
                          twice + ", as " + first->type + " and as " + parameter.type);
        continue;
      }
      parameter.again = twice + ": this one counts";
      *first = std::move(parameter);
      continue;
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

}  // namespace caplet::pbrt
