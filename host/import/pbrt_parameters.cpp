// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>
#include <utility>

#include "base/reading.h"
#include "base/spelling.h"
#include "import/detail/gzip_file.h"
#include "import/detail/pbrt_names.h"
#include "import/detail/pbrt_spectrum_file.h"
#include "import/detail/pbrt_v3.h"

namespace caplet::pbrt {

namespace {

struct TypeRow {
  std::string_view name, canonical;
  std::size_t multiple;  // of which the number of values is a multiple
  bool single;           // there is exactly that number
};

const std::vector<TypeRow>& type_rows() {
  static const std::vector<TypeRow> rows = {
      {"integer", "integer", 1, false},   {"float", "float", 1, false},   {"bool", "bool", 1, false},
      {"string", "string", 1, false},     {"point2", "point2", 2, false}, {"vector2", "vector2", 2, false},
      {"point3", "point3", 3, false},     {"point", "point3", 3, false},  {"vector3", "vector3", 3, false},
      {"vector", "vector3", 3, false},    {"normal", "normal", 3, false}, {"normal3", "normal", 3, false},
      {"spectrum", "spectrum", 1, false}, {"rgb", "rgb", 3, false},       {"blackbody", "blackbody", 1, true},
      {"texture", "texture", 1, true}};
  return rows;
}

const TypeRow* find_type(std::string_view name) {
  for (const TypeRow& row : type_rows())
    if (row.name == name) return &row;
  return nullptr;
}

std::string unknown_type(std::string_view type) {
  const std::string unknown = "unknown parameter type " + in_quotes(type);
  if (const std::string old = v3_name("type", type); !old.empty()) return unknown + ": that is " + old;
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
      throw SyntaxError{lexer.place(token), "expected true or false, found " + in_quotes(token.text)};
    parameter.bools.push_back(token.text == "true");
  } else if (parameter.type == "string" || parameter.type == "texture" || (parameter.type == "spectrum" && is_string)) {
    if (!is_string) throw SyntaxError{lexer.place(token), "expected a quoted string, found " + in_quotes(token.text)};
    parameter.strings.emplace_back(token.text);
  } else if (parameter.type == "integer") {
    if (is_string) throw SyntaxError{lexer.place(token), "expected an integer, found the string " + in_quotes(token.text)};
    parameter.numbers.push_back(parse_integer(token, lexer));
  } else {
    if (is_string) throw SyntaxError{lexer.place(token), "expected a number, found the string " + in_quotes(token.text)};
    parameter.numbers.push_back(parse_number(token, lexer));
  }
}

void skip_values(Lexer& lexer) {
  if (lexer.peek().kind == Token::Kind::close) lexer.next();
  if (lexer.peek().kind != Token::Kind::open) return;
  while (lexer.peek().kind != Token::Kind::close && lexer.peek().kind != Token::Kind::end) lexer.next();
  if (lexer.peek().kind == Token::Kind::close) lexer.next();
}

bool takes_numbers(const std::string& type) {
  return type != "bool" && type != "string" && type != "texture" && type != "spectrum";
}

/// Parses the values after a declaration. The first wrong value is kept in `problem`, and the rest is skipped.
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
      throw SyntaxError{lexer.place(lexer.peek()),
                        "the parameter " + in_quotes(parameter.type + " " + parameter.name) + " has no value"};
    add(lexer.next());
    return;
  }
  const Token open = lexer.next();
  if (takes_numbers(parameter.type)) lexer.take_numbers(parameter.numbers, parameter.type == "integer");
  while (lexer.peek().kind != Token::Kind::close) {
    if (lexer.peek().kind == Token::Kind::end) throw SyntaxError{lexer.place(open), "this bracket is never closed"};
    if (lexer.peek().kind == Token::Kind::open) throw SyntaxError{lexer.place(lexer.peek()), "a bracket within brackets"};
    add(lexer.next());
  }
  lexer.next();
}

/// Returns a texture's refusal without its place.
std::string kind_of(const std::string& refusal) { return refusal.substr(0, refusal.find(" (")); }

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

/// Returns the lexer at the next parameter, or null. A statement at the end of an included file continues after the Include, as
/// in pbrt-v4.
Lexer* at_parameter(Lexer& lexer) {
  Lexer* at = &lexer;
  while (at && at->peek().kind == Token::Kind::end) at = at->behind();
  return at && at->peek().kind == Token::Kind::string ? at : nullptr;
}

/// Returns whether values without a stated type fit this one. A spectrum of one number is a float, of three numbers an rgb.
bool suits(const Parameter& parameter, std::string_view type) {
  const std::size_t count = parameter.numbers.size();
  if (!parameter.bools.empty()) return type == "bool";
  if (!parameter.strings.empty()) return type == "string" || type == "spectrum" || type == "texture";
  if (type == "bool" || type == "string" || type == "texture" || type == "blackbody" || count == 0) return false;
  if (type == "spectrum") return count > 3 && count % 2 == 0;
  if (type == "integer")
    return std::ranges::all_of(parameter.numbers, [](double x) { return x == std::floor(x) && std::abs(x) <= 2147483647.0; });
  return count % find_type(type)->multiple == 0;
}

/// Describes the given values for messages.
std::string values_of(const Parameter& parameter) {
  const auto some = [](std::size_t count, const char* what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  };
  if (!parameter.bools.empty()) return some(parameter.bools.size(), "bool");
  if (!parameter.strings.empty()) return in_quotes(parameter.strings[0]);
  return some(parameter.numbers.size(), "number");
}

/// Says why a parameter given without a type is of none of these.
std::string mismatch(const Parameter& parameter, const std::string& wanted) {
  if (wanted == "integer")
    for (const double x : parameter.numbers)
      if (x != std::floor(x)) return fmt::format("must be a whole number, not {}", x);
  return "must be of type " + wanted + ", not " + values_of(parameter);
}

std::string plural(std::size_t count) { return std::to_string(count) + (count == 1 ? " value" : " values"); }

/// Returns the error in a parameter's number of values; empty when it is right.
std::string check_count(const Parameter& parameter, const TypeRow& row) {
  const std::size_t count = parameter.numbers.size() + parameter.strings.size() + parameter.bools.size();
  const std::string name = in_quotes(parameter.type + " " + parameter.name);
  if (count == 0) return "the parameter " + name + " has no value";
  if (parameter.type == "spectrum") {
    if (!parameter.strings.empty() && !parameter.numbers.empty()) return name + " mixes names and numbers";
    if (parameter.strings.size() > 1) return name + " takes one name or file, not " + std::to_string(parameter.strings.size());
    if (parameter.numbers.size() % 2) return name + " takes pairs of wavelength and value, not " + plural(count);
    for (std::size_t i = 2; i < parameter.numbers.size(); i += 2)
      if (parameter.numbers[i] <= parameter.numbers[i - 2]) return name + ": wavelengths must ascend";
    return {};
  }
  if (row.single && count != row.multiple) return name + " takes " + plural(row.multiple) + ", not " + std::to_string(count);
  if (count % row.multiple) return name + " takes a multiple of " + plural(row.multiple) + ", not " + std::to_string(count);
  return {};
}

}  // namespace

std::vector<Parameter> parse_parameters(Lexer& statement, ColorSpace space, Diagnostics& diagnostics) {
  std::vector<Parameter> parameters;
  GivenNames given;
  while (Lexer* const at = at_parameter(statement)) {
    Lexer& lexer = *at;
    const Token declaration = lexer.next();
    Parameter parameter;
    parameter.where = lexer.place(declaration);
    parameter.space = space;
    const auto [type, name] = split_declaration(declaration.text);
    const TypeRow* row = find_type(type);
    if (type.empty() || !row) {
      if (type.empty())
        diagnostics.error(parameter.where, "expected a parameter (\"type name\"), found " + in_quotes(declaration.text));
      else
        diagnostics.error(parameter.where, unknown_type(type), "parameter type " + std::string(type));
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
      diagnostics.error(problem->where, in_quotes(parameter.type + " " + parameter.name) + ": " + problem->message);
      parameter.broken = true;
    } else if (const std::string complaint = check_count(parameter, *row); !complaint.empty()) {
      diagnostics.error(parameter.where, complaint);
      parameter.broken = true;
    }
    if (Parameter* first = given.find(parameters, parameter.name)) {
      const std::string twice =
          "the parameter " + in_quotes(parameter.name) + " is given twice (first at " + first->where.to_string() + ")";
      if (first->type != parameter.type) {
        diagnostics.error(parameter.where, twice + ", as " + first->type + " and as " + parameter.type);
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

void add_errors(const InputError& problem, const SourceLocation& where, Diagnostics& diagnostics) {
  const std::string place = where.to_string();
  for (const std::string& message : problem.messages())
    if (message.starts_with(place + ": "))
      diagnostics.error({}, message);
    else
      diagnostics.error(where, message);
}

std::string resolve_file(const std::string& name, const SourceLocation& where, const std::string& main_file) {
  namespace fs = std::filesystem;
  const fs::path path(name);
  check_may_read(path.is_absolute() ? path : fs::path(where.file).parent_path() / path, where);
  if (path.is_absolute()) return name;
  const fs::path beside = fs::path(where.file).parent_path() / path;
  if (is_there(beside, where)) return beside.string();
  const fs::path main = fs::path(main_file).parent_path() / path;
  return is_there(main, where) ? main.string() : beside.string();
}

Parameters::Parameters(std::vector<Parameter> own, SharedParameters attributes, std::string owner, SourceLocation where,
                       const std::string& main_file, ColorSpace space, Diagnostics& diagnostics)
    : own_(std::move(own)),
      attributes_(std::move(attributes)),
      owner_(std::move(owner)),
      where_(std::move(where)),
      main_file_(&main_file),
      space_(space),
      diagnostics_(&diagnostics) {}

const Parameter* Parameters::lookup(std::string_view name) const {
  for (const Parameter& parameter : own_)
    if (parameter.name == name) return &parameter;
  for (auto it = attributes_.rbegin(); it != attributes_.rend(); ++it)
    if ((*it)->name == name) return it->get();
  return nullptr;
}

Parameter* Parameters::find(std::string_view name) {
  if (asked_.empty()) asked_.reserve(16);
  asked_.push_back(name);
  Parameter* found = nullptr;
  for (const auto& attribute : attributes_)
    if (attribute->name == name) {
      attribute->used = true;
      found = attribute.get();
    }
  for (Parameter& parameter : own_)
    if (parameter.name == name) {
      parameter.used = true;
      found = &parameter;
    }
  return found;
}

SourceLocation Parameters::where(std::string_view name) const {
  const Parameter* parameter = lookup(name);
  return parameter ? parameter->where : where_;
}

void Parameters::error(std::string_view name, const std::string& message, const std::string& kind) {
  diagnostics_->error(where(name), owner_ + ": \"" + std::string(name) + "\" " + message, kind);
}

bool Parameters::has(std::string_view name) { return find(name) != nullptr; }

const Parameter* Parameters::values(std::string_view name, std::initializer_list<std::string_view> types) {
  Parameter* parameter = find(name);
  if (!parameter || parameter->broken) return nullptr;
  if (parameter->type.empty()) {
    for (const std::string_view type : types) {
      // Where a spectrum is allowed too, only three numbers are an rgb.
      if (type == "rgb" && types.size() > 1 && parameter->numbers.size() != 3) continue;
      if (!suits(*parameter, type)) continue;
      parameter->type = type;
      break;
    }
    if (parameter->type.empty()) {
      std::string wanted;
      for (const std::string_view type : types) wanted += (wanted.empty() ? "" : " or ") + std::string(type);
      error(name, mismatch(*parameter, wanted));
      parameter->broken = true;
      return nullptr;
    }
  }
  if (std::find(types.begin(), types.end(), parameter->type) != types.end()) return parameter;
  std::string wanted;
  for (std::string_view type : types) wanted += (wanted.empty() ? "" : " or ") + std::string(type);
  error(name, "must be of type " + wanted + ", not " + parameter->type);
  return nullptr;
}

double Parameters::number(std::string_view name, double fallback) {
  const Parameter* parameter = values(name, {"float"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 1) return parameter->numbers[0];
  error(name, "takes 1 value, not " + std::to_string(parameter->numbers.size()));
  return fallback;
}

int Parameters::integer(std::string_view name, int fallback) {
  const Parameter* parameter = values(name, {"integer"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 1) return static_cast<int>(parameter->numbers[0]);
  error(name, "takes 1 value, not " + std::to_string(parameter->numbers.size()));
  return fallback;
}

bool Parameters::boolean(std::string_view name, bool fallback) {
  const Parameter* parameter = values(name, {"bool"});
  if (!parameter) return fallback;
  if (parameter->bools.size() == 1) return parameter->bools[0];
  error(name, "takes 1 value, not " + std::to_string(parameter->bools.size()));
  return fallback;
}

std::string Parameters::text(std::string_view name, const std::string& fallback) {
  const Parameter* parameter = values(name, {"string"});
  if (!parameter) return fallback;
  if (parameter->strings.size() == 1) return parameter->strings[0];
  error(name, "takes 1 value, not " + std::to_string(parameter->strings.size()));
  return fallback;
}

glm::dvec3 Parameters::point(std::string_view name, const glm::dvec3& fallback) {
  const Parameter* parameter = values(name, {"point3"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 3) return {parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]};
  error(name, "takes 1 point, not " + std::to_string(parameter->numbers.size() / 3));
  return fallback;
}

glm::dvec3 Parameters::vector(std::string_view name, const glm::dvec3& fallback) {
  const Parameter* parameter = values(name, {"vector3"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 3) return {parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]};
  error(name, "takes 1 vector, not " + std::to_string(parameter->numbers.size() / 3));
  return fallback;
}

std::optional<Spectrum> Parameters::spectrum(std::string_view name, SpectrumUse use, const TextureTable* textures) {
  const Parameter* parameter = textures ? values(name, {"rgb", "spectrum", "blackbody", "float", "texture"})
                                        : values(name, {"rgb", "spectrum", "blackbody", "float"});
  return parameter ? spectrum_of(*parameter, use, textures) : std::nullopt;
}

std::optional<Spectrum> Parameters::spectrum_of(const Parameter& parameter, SpectrumUse use, const TextureTable* textures) {
  const auto wrong = [&](const std::string& message) {
    error(parameter.name, message);
    return std::nullopt;
  };
  if (parameter.type == "texture") {
    const TextureValue* found = textures->find(parameter.strings[0], false);
    if (!found || found->is_float)
      return wrong((found ? "needs a spectrum texture, not the float texture " : "names an unknown texture, ") +
                   in_quotes(parameter.strings[0]));
    if (!found->refusal.empty()) {
      error(parameter.name, "uses " + found->refusal, kind_of(found->refusal));
      return std::nullopt;
    }
    if (found->texture) return wrong("takes no texture other than constants here");
    return found->spectrum;
  }
  if (parameter.type == "float") {
    if (parameter.numbers.size() != 1) return wrong("takes 1 value, not " + std::to_string(parameter.numbers.size()));
    if (parameter.numbers[0] < 0) return wrong("must not be negative");
    if (use == SpectrumUse::albedo && parameter.numbers[0] > 1) return wrong("is a reflectance above 1");
    return ConstantSpectrum{parameter.numbers[0]};
  }
  if (parameter.type == "rgb") {
    if (parameter.numbers.size() != 3) return wrong("takes 3 values, not " + std::to_string(parameter.numbers.size()));
    const RgbSpectrum rgb{{parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]}, parameter.space};
    if (std::min({rgb.rgb.x, rgb.rgb.y, rgb.rgb.z}) < 0) return wrong("has a negative component");
    if (use == SpectrumUse::albedo && std::max({rgb.rgb.x, rgb.rgb.y, rgb.rgb.z}) > 1)
      return wrong("is a reflectance and has a component above 1");
    return rgb;
  }
  if (parameter.type == "blackbody") {
    if (parameter.numbers[0] <= 0) return wrong("must be a positive temperature in kelvin");
    return BlackbodySpectrum{parameter.numbers[0]};
  }
  SampledSpectrum sampled;
  if (!parameter.strings.empty()) {
    if (auto named = named_spectrum(parameter.strings[0])) return named;
    const std::string file = resolve_file(parameter.strings[0], parameter.where, *main_file_);
    if (!is_there(file, parameter.where))
      return wrong("names neither a known spectrum nor a file, " + in_quotes(parameter.strings[0]) +
                   (diagnostics_->is_full()
                        ? ""
                        : "; the nearest known name is \"" + nearest_name(parameter.strings[0], named_spectrum_names()) + "\""));
    try {
      sampled = read_spectrum_file(file, parameter.where);
    } catch (const InputError& problem) {
      add_errors(problem, parameter.where, *diagnostics_);
      return std::nullopt;
    }
  }
  for (std::size_t i = 0; i < parameter.numbers.size(); i += 2) {
    sampled.wavelengths.push_back(parameter.numbers[i]);
    sampled.values.push_back(parameter.numbers[i + 1]);
  }
  if (*std::min_element(sampled.values.begin(), sampled.values.end()) < 0) return wrong("has a negative value");
  if (use == SpectrumUse::albedo && *std::max_element(sampled.values.begin(), sampled.values.end()) > 1)
    return wrong("is a reflectance and has a value above 1");
  return sampled;
}

double Parameters::number_or_texture(std::string_view name, double fallback, const TextureTable& textures) {
  const Parameter* parameter = values(name, {"float", "texture"});
  if (!parameter) return fallback;
  if (parameter->type == "float") return number(name, fallback);
  const TextureValue* found = textures.find(parameter->strings[0], true);
  if (!found)
    error(name, "names an unknown texture, " + in_quotes(parameter->strings[0]));
  else if (!found->is_float)
    error(name, "needs a float texture, not the spectrum texture " + in_quotes(parameter->strings[0]));
  else if (!found->refusal.empty())
    error(name, "uses " + found->refusal, kind_of(found->refusal));
  else if (found->texture)
    error(name, "takes no texture other than constants here");
  else
    return found->number;
  return fallback;
}

std::optional<std::uint32_t> Parameters::texture(std::string_view name, bool is_float, const TextureTable& textures) {
  const Parameter* parameter = find(name);
  if (!parameter || parameter->type != "texture") return std::nullopt;
  const TextureValue* found = textures.find(parameter->strings[0], is_float);
  return found && found->is_float == is_float && found->refusal.empty() ? found->texture : std::nullopt;
}

void Parameters::refuse(std::string_view name) {
  if (find(name)) error(name, "is not rendered yet", "not rendered: " + std::string(name));
}

void Parameters::ignore(std::string_view name) { find(name); }

void Parameters::finish() {
  for (const auto& attribute : attributes_) attribute->consulted = true;
  for (const Parameter& parameter : own_) {
    if (parameter.used) continue;
    const std::string directive = owner_.substr(0, owner_.find(' ')),
                      unknown = ": unknown parameter " + in_quotes(parameter.name);
    std::string message = owner_ + unknown;
    if (const std::string old = v3_parameter(directive, parameter.name); !old.empty())
      message += ": that is " + old;
    else if (!asked_.empty() && !diagnostics_->is_full())
      message += "; the nearest known name is \"" + nearest_name(parameter.name, {asked_.begin(), asked_.end()}) + "\"";
    diagnostics_->error(parameter.where, message, directive + unknown);
  }
}

}  // namespace caplet::pbrt
