// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/parser.h"

#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/spelling.h"
#include "import/detail/pbrt/names.h"
#include "import/detail/pbrt/v3.h"

namespace caplet::pbrt {

namespace {

struct Directive {
  const char* name;
  void (*read)(Arguments& given, Parser& parser);
  enum class Allowed { anywhere, options, world } allowed;
};

/// Calls a method of the interface of the target that has it.
template <class Interface, class... Taken, class... Given>
void call(Parser& parser, void (Interface::*method)(const Statement&, Taken...), Arguments& from,
          Given&&... given) {
  (std::get<Interface&>(parser.target()).*method)(from.statement(), std::forward<Given>(given)...);
}

template <auto method>
void alone(Arguments& given, Parser& parser) {
  call(parser, method, given);
}

template <auto method>
void with_type(Arguments& given, Parser& parser) {
  const std::string type = given.string("a type").text;
  call(parser, method, given, type, given.parameters());
}

template <auto method>
void with_name_and_parameters(Arguments& given, Parser& parser) {
  const std::string name = given.string("a name").text;
  call(parser, method, given, name, given.parameters());
}

template <auto method>
void with_name(Arguments& given, Parser& parser) {
  call(parser, method, given, given.string("a name"));
}

template <auto method>
void with_matrix(Arguments& given, Parser& parser) {
  call(parser, method, given, given.matrix());
}

template <auto method>
void with_vector(Arguments& given, Parser& parser) {
  call(parser, method, given, given.vector());
}

void active_transform(Arguments& given, Parser& parser) {
  const Token token = given.lexer().next();
  call(parser, &TransformTarget::active_transform, given,
       Word{std::string(token.text), given.lexer().place(token)});
}

void attribute(Arguments& given, Parser& parser) {
  const Word target = given.string("a target");
  call(parser, &StateTarget::attribute, given, target, given.parameters());
}

void import_file(Arguments& given, Parser& parser) {
  call(parser, &StateTarget::import, given, given.string("a file name"),
       [&](const std::string& file, std::string text) {
         parser.parse(file, std::move(text), nullptr);
       });
}

void include_file(Arguments& given, Parser& parser) {
  call(parser, &StateTarget::include, given, given.string("a file name"),
       [&](const std::string& file, std::string text) {
         parser.parse(file, std::move(text), &given.lexer());
       });
}

void look_at(Arguments& given, Parser& parser) {
  const glm::dvec3 eye = given.vector(), target = given.vector(), up = given.vector();
  call(parser, &TransformTarget::look_at, given, eye, target, up);
}

void medium_interface(Arguments& given, Parser& parser) {
  const auto side = [&] { return given.string("a medium's name (or \"\")"); };
  const Word inside = side();
  const std::optional<Word> outside = given.is_string_next() ? std::optional(side()) : std::nullopt;
  call(parser, &SceneTarget::medium_interface, given, inside, outside);
}

void object_begin(Arguments& given, Parser& parser) {
  call(parser, &StateTarget::object_begin, given, given.string("a name").text);
}

void object_instance(Arguments& given, Parser& parser) {
  call(parser, &StateTarget::object_instance, given, given.string("an object's name").text);
}

void option(Arguments& given, Parser& parser) {
  std::string name = given.string("a name").text;
  if (const std::size_t blank = name.find_last_of(" \t"); blank != std::string::npos)
    name = name.substr(blank + 1);
  Lexer& lexer = given.lexer();
  const bool bracket = lexer.peek().kind == Token::Kind::open;
  if (bracket) lexer.next();
  const Token value = lexer.next();
  if (value.kind != Token::Kind::word && value.kind != Token::Kind::string)
    throw SyntaxError{lexer.place(value), "Option needs a value, found " + in_quotes(value.text)};
  if (bracket && lexer.next().kind != Token::Kind::close)
    throw SyntaxError{given.statement().where, "Option takes one value"};
  call(parser, &OptionTarget::option, given, name, value);
}

void rotate(Arguments& given, Parser& parser) {
  const double degrees = given.number();
  call(parser, &TransformTarget::rotate, given, degrees, given.vector());
}

void texture(Arguments& given, Parser& parser) {
  const std::string name = given.string("a name").text;
  const Word kind = given.string("\"float\" or \"spectrum\""),
             texture_class = given.string("a class");
  call(parser, &SceneTarget::texture, given, name, kind, texture_class, given.parameters());
}

void transform_times(Arguments& given, Parser& parser) {
  const double start = given.number(), end = given.number();
  call(parser, &TransformTarget::transform_times, given, start, end);
}

const std::vector<Directive>& directives() {
  using enum Directive::Allowed;
  static const std::vector<Directive> rows = {
      {"Accelerator", with_type<&OptionTarget::accelerator>, options},
      {"ActiveTransform", active_transform, anywhere},
      {"AreaLightSource", with_type<&SceneTarget::area_light_source>, world},
      {"Attribute", attribute, anywhere},
      {"AttributeBegin", alone<&StateTarget::attribute_begin>, world},
      {"AttributeEnd", alone<&StateTarget::attribute_end>, world},
      {"Camera", with_type<&OptionTarget::camera>, options},
      {"ColorSpace", with_name<&StateTarget::color_space>, anywhere},
      {"ConcatTransform", with_matrix<&TransformTarget::concat_transform>, anywhere},
      {"CoordSysTransform", with_name<&TransformTarget::coord_sys_transform>, anywhere},
      {"CoordinateSystem", with_name<&TransformTarget::coordinate_system>, anywhere},
      {"Film", with_type<&OptionTarget::film>, options},
      {"Identity", alone<&TransformTarget::identity>, anywhere},
      {"Import", import_file, world},
      {"Include", include_file, anywhere},
      {"Integrator", with_type<&OptionTarget::integrator>, options},
      {"InverseTransform", with_matrix<&TransformTarget::inverse_transform>, anywhere},
      {"LightSource", with_type<&SceneTarget::light_source>, world},
      {"LookAt", look_at, anywhere},
      {"MakeNamedMaterial", with_name_and_parameters<&SceneTarget::make_named_material>, world},
      {"MakeNamedMedium", with_name_and_parameters<&SceneTarget::make_named_medium>, anywhere},
      {"Material", with_type<&SceneTarget::material>, world},
      {"MediumInterface", medium_interface, anywhere},
      {"NamedMaterial", with_name<&SceneTarget::named_material>, world},
      {"ObjectBegin", object_begin, world},
      {"ObjectEnd", alone<&StateTarget::object_end>, world},
      {"ObjectInstance", object_instance, world},
      {"Option", option, options},
      {"PixelFilter", with_type<&OptionTarget::pixel_filter>, options},
      {"ReverseOrientation", alone<&StateTarget::reverse_orientation>, world},
      {"Rotate", rotate, anywhere},
      {"Sampler", with_type<&OptionTarget::sampler>, options},
      {"Scale", with_vector<&TransformTarget::scale>, anywhere},
      {"Shape", with_type<&SceneTarget::shape>, world},
      {"Texture", texture, world},
      {"Transform", with_matrix<&TransformTarget::transform>, anywhere},
      {"TransformBegin", alone<&StateTarget::transform_begin>, world},
      {"TransformEnd", alone<&StateTarget::transform_end>, world},
      {"TransformTimes", transform_times, options},
      {"Translate", with_vector<&TransformTarget::translate>, anywhere},
      {"WorldBegin", alone<&StateTarget::world_begin>, options},
  };
  return rows;
}

/// Returns the directive of a token. Throws SyntaxError if it is none.
const Directive& directive_of(const Token& token, const SourceLocation& where) {
  static const auto by_name = [] {
    std::unordered_map<std::string_view, const Directive*> map;
    for (const Directive& row : directives()) map.emplace(row.name, &row);
    return map;
  }();
  if (token.kind != Token::Kind::word)
    throw SyntaxError{where,
                      "expected a directive, found " +
                          std::string(token.kind == Token::Kind::string ? "the string " : "") +
                          in_quotes(token.text)};
  if (const auto found = by_name.find(token.text); found != by_name.end()) return *found->second;
  const std::string unknown = "unknown directive " + in_quotes(token.text),
                    old = v3_name("", token.text);
  throw SyntaxError{where,
                    unknown + (old.empty() ? "; the nearest known name is \"" +
                                                 nearest_name(token.text, directive_names()) + "\""
                                           : ": " + old),
                    unknown};
}

/// Throws SyntaxError for a directive on the wrong side of WorldBegin.
void check_allowed(const Directive& row, const SourceLocation& where, bool in_world) {
  const std::string name = row.name;
  if (row.allowed == Directive::Allowed::options && in_world)
    throw SyntaxError{where, name + (name == "WorldBegin" ? " is given twice"
                                                          : " is only allowed before WorldBegin")};
  if (row.allowed == Directive::Allowed::world && !in_world)
    throw SyntaxError{where, name + " is only allowed after WorldBegin"};
}

}  // namespace

Word Arguments::string(const char* what) {
  const Token& token = lexer_.peek();
  if (token.kind != Token::Kind::string)
    throw SyntaxError{lexer_.place(token), std::string(statement_.directive) + " needs " + what +
                                               " in quotes, found " + in_quotes(token.text)};
  SourceLocation where = lexer_.place(token);
  return {std::string(lexer_.next().text), std::move(where)};
}

double Arguments::number() {
  const Token& token = lexer_.peek();
  if (token.kind != Token::Kind::word)
    throw SyntaxError{lexer_.place(token), std::string(statement_.directive) +
                                               " needs a number, found " + in_quotes(token.text)};
  const double value = parse_number(token, lexer_.file());
  lexer_.next();
  return value;
}

glm::dvec3 Arguments::vector() {
  const double x = number(), y = number(), z = number();
  return {x, y, z};
}

glm::dmat4 Arguments::matrix() {
  const bool bracket = lexer_.peek().kind == Token::Kind::open;
  if (bracket) lexer_.next();
  glm::dmat4 matrix;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) matrix[column][row] = number();
  if (!bracket) return matrix;
  if (lexer_.peek().kind != Token::Kind::close)
    throw SyntaxError{lexer_.place(lexer_.peek()), std::string(statement_.directive) +
                                                       " takes 16 numbers, found " +
                                                       in_quotes(lexer_.peek().text)};
  lexer_.next();
  return matrix;
}

void Parser::parse(const std::string& file, std::string text, Lexer* behind) {
  Lexer lexer(file, std::move(text), behind);
  const bool is_included = depth_++ > 0;
  Unproven in_file;
  for (bool more = true; more;) {
    const std::size_t errors = diagnostics_.error_count();
    try {
      more = lexer.peek().kind != Token::Kind::end;
      if (more) parse_statement(lexer, in_file);
      if (more && diagnostics_.error_count() == errors) in_file.prove();
    } catch (const SyntaxError& error) {
      diagnostics_.error(error.where, error.message, error.kind);
      if (is_included && !in_file.is_proven()) break;  // an included file that is no scene
      skip_to_directive(lexer);
    }
  }
  --depth_;
}

void Parser::parse_statement(Lexer& lexer, Unproven& in_file) {
  const Token token = lexer.next();
  Statement statement{{}, lexer.place(token)};
  const Directive& directive = directive_of(token, statement.where);
  statement.directive = directive.name;
  check_allowed(directive, statement.where, in_world_);
  // A known type proves that the file is a scene, whatever else is wrong with it.
  if (const Token& type = lexer.peek(); type.kind == Token::Kind::string)
    if (is_known_name(statement.directive, std::string(type.text)) ||
        !v3_name(statement.directive, type.text).empty())
      in_file.prove();
  if (statement.directive == "WorldBegin") in_world_ = true;
  Arguments given(lexer, statement, diagnostics_);
  directive.read(given, *this);
}

void Parser::skip_to_directive(Lexer& lexer) {
  static const std::unordered_set<std::string_view> names(directive_names().begin(),
                                                          directive_names().end());
  for (;;) {
    try {
      const Token& token = lexer.peek();
      if (token.kind == Token::Kind::end ||
          (token.kind == Token::Kind::word && names.contains(token.text)))
        return;
      lexer.next();
    } catch (const SyntaxError& error) {
      diagnostics_.error(error.where, error.message);
    }
  }
}

}  // namespace caplet::pbrt
