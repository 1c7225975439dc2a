// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt_parser.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <unordered_set>

#include "base/log.h"
#include "base/quotes.h"
#include "base/spelling.h"
#include "import/detail/gzip_file.h"
#include "import/detail/pbrt_names.h"
#include "import/detail/pbrt_v3.h"
#include "present/present.h"

namespace caplet::pbrt {

namespace fs = std::filesystem;

namespace {
constexpr std::size_t deepest_include = 64;
// These limits stop files that include each other many times; real scenes stay far below.
constexpr std::size_t most_included_files = 1 << 16;
constexpr std::size_t most_included_again = std::size_t{1} << 28;  // bytes of files that were read before
}  // namespace

const std::vector<Parser::Handler>& Parser::handlers() {
  using enum Handler::Allowed;
  static const std::vector<Handler> rows = {
      {"Accelerator", &Parser::accelerator, options},
      {"ActiveTransform", &Parser::active_transform, anywhere},
      {"AreaLightSource", &Parser::area_light_source, world},
      {"Attribute", &Parser::attribute, anywhere},
      {"AttributeBegin", &Parser::attribute_begin, world},
      {"AttributeEnd", &Parser::attribute_end, world},
      {"Camera", &Parser::camera, options},
      {"ColorSpace", &Parser::color_space, anywhere},
      {"ConcatTransform", &Parser::concat_transform, anywhere},
      {"CoordSysTransform", &Parser::coord_sys_transform, anywhere},
      {"CoordinateSystem", &Parser::coordinate_system, anywhere},
      {"Film", &Parser::film, options},
      {"Identity", &Parser::identity, anywhere},
      {"Import", &Parser::import, world},
      {"Include", &Parser::include, anywhere},
      {"Integrator", &Parser::integrator, options},
      {"InverseTransform", &Parser::inverse_transform, anywhere},
      {"LightSource", &Parser::light_source, world},
      {"LookAt", &Parser::look_at, anywhere},
      {"MakeNamedMaterial", &Parser::make_named_material, world},
      {"MakeNamedMedium", &Parser::make_named_medium, anywhere},
      {"Material", &Parser::material, world},
      {"MediumInterface", &Parser::medium_interface, anywhere},
      {"NamedMaterial", &Parser::named_material, world},
      {"ObjectBegin", &Parser::object_begin, world},
      {"ObjectEnd", &Parser::object_end, world},
      {"ObjectInstance", &Parser::object_instance, world},
      {"Option", &Parser::option, options},
      {"PixelFilter", &Parser::pixel_filter, options},
      {"ReverseOrientation", &Parser::reverse_orientation, world},
      {"Rotate", &Parser::rotate, anywhere},
      {"Sampler", &Parser::sampler, options},
      {"Scale", &Parser::scale, anywhere},
      {"Shape", &Parser::shape, world},
      {"Texture", &Parser::texture, world},
      {"Transform", &Parser::transform, anywhere},
      {"TransformBegin", &Parser::attribute_begin, world},
      {"TransformEnd", &Parser::attribute_end, world},
      {"TransformTimes", &Parser::transform_times, options},
      {"Translate", &Parser::translate, anywhere},
      {"WorldBegin", &Parser::world_begin, options},
  };
  return rows;
}

Imported Parser::parse(std::string text) {
  scene_.source = main_file_;
  std::error_code ignored;
  open_files_.push_back({main_file_, fs::weakly_canonical(main_file_, ignored).string()});
  parse_file(main_file_, std::move(text));
  report_unclosed(0);
  if (!in_world_ && !diagnostics_.has_errors()) diagnostics_.error({main_file_}, "the scene is empty: there is no WorldBegin");
  resolve_media();
  resolve_materials();
  finish_attributes();
  resolve_instances();
  log_warnings();
  diagnostics_.finish();
  scene_.sampler.seed = sampler_seed_.value_or(option_seed_.value_or(0));
  const bool lit = is_lit(scene_);
  if (has_camera_ && !lit) diagnostics_.warning({main_file_}, "the scene has no light: its picture is black");
  Imported out(std::move(scene_));
  out.has_camera = has_camera_;
  out.is_lit = lit || has_camera_;  // an explicit camera without light means a dark scene
  return out;
}

void Parser::parse_file(const std::string& file, std::string text, Lexer* behind) {
  Lexer lexer(file, std::move(text), behind);
  Lexer* const outer = std::exchange(lexer_, &lexer);
  Unproven in_file;
  for (bool more = true; more;) {
    const std::size_t errors = diagnostics_.error_count();
    try {
      more = lexer.peek().kind != Token::Kind::end;
      if (more) parse_statement(in_file);
      if (more && diagnostics_.error_count() == errors) in_file.prove();
    } catch (const SyntaxError& error) {
      diagnostics_.error(error.where, error.message, error.kind);
      if (outer && !in_file.is_proven()) break;  // an included file that is no scene
      skip_to_directive();
    }
  }
  lexer_ = outer;
}

void Parser::parse_statement(Unproven& in_file) {
  static const auto by_name = [] {
    std::unordered_map<std::string_view, const Handler*> map;
    for (const Handler& row : handlers()) map.emplace(row.name, &row);
    return map;
  }();
  const Token token = lexer_->next();
  where_ = lexer_->place(token);
  if (token.kind != Token::Kind::word)
    throw SyntaxError{where_, "expected a directive, found " +
                                  std::string(token.kind == Token::Kind::string ? "the string " : "") + in_quotes(token.text)};
  const auto found = by_name.find(token.text);
  if (found == by_name.end()) {
    const std::string unknown = "unknown directive " + in_quotes(token.text), old = v3_name("", token.text);
    throw SyntaxError{
        where_,
        unknown +
            (old.empty() ? "; the nearest known name is \"" + nearest_name(token.text, directive_names()) + "\"" : ": " + old),
        unknown};
  }
  directive_ = token.text;
  const Handler& handler = *found->second;
  if (handler.allowed == Handler::Allowed::options && in_world_)
    throw SyntaxError{where_,
                      directive_ + (directive_ == "WorldBegin" ? " is given twice" : " is only allowed before WorldBegin")};
  if (handler.allowed == Handler::Allowed::world && !in_world_)
    throw SyntaxError{where_, directive_ + " is only allowed after WorldBegin"};
  // A known type proves that the file is a scene, whatever else is wrong with it.
  if (const Token& type = lexer_->peek(); type.kind == Token::Kind::string)
    if (is_known_name(directive_, std::string(type.text)) || !v3_name(directive_, type.text).empty()) in_file.prove();
  (this->*handler.run)();
}

void Parser::skip_to_directive() {
  static const std::unordered_set<std::string_view> names(directive_names().begin(), directive_names().end());
  for (;;) {
    try {
      const Token& token = lexer_->peek();
      if (token.kind == Token::Kind::end || (token.kind == Token::Kind::word && names.contains(token.text))) return;
      lexer_->next();
    } catch (const SyntaxError& error) {
      diagnostics_.error(error.where, error.message);
    }
  }
}

std::string Parser::string_argument(const char* what) {
  const Token& token = lexer_->peek();
  if (token.kind != Token::Kind::string)
    throw SyntaxError{lexer_->place(token), directive_ + " needs " + what + " in quotes, found " + in_quotes(token.text)};
  return std::string(lexer_->next().text);
}

double Parser::number_argument() {
  const Token& token = lexer_->peek();
  if (token.kind != Token::Kind::word)
    throw SyntaxError{lexer_->place(token), directive_ + " needs a number, found " + in_quotes(token.text)};
  const double value = parse_number(token, *lexer_);
  lexer_->next();
  return value;
}

glm::dvec3 Parser::vector_argument() {
  const double x = number_argument(), y = number_argument(), z = number_argument();
  return {x, y, z};
}

glm::dmat4 Parser::matrix_argument() {
  const bool bracket = lexer_->peek().kind == Token::Kind::open;
  if (bracket) lexer_->next();
  glm::dmat4 matrix;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) matrix[column][row] = number_argument();
  if (!bracket) return matrix;
  if (lexer_->peek().kind != Token::Kind::close)
    throw SyntaxError{lexer_->place(lexer_->peek()), directive_ + " takes 16 numbers, found " + in_quotes(lexer_->peek().text)};
  lexer_->next();
  return matrix;
}

std::vector<Parameter> Parser::own_parameters() {
  std::vector<Parameter> own = parse_parameters(*lexer_, state_.space, diagnostics_);
  for (const Parameter& parameter : own)
    if (!parameter.again.empty()) warn_of_kind(parameter.where, parameter.again, "parameter given twice");
  return own;
}

Parameters Parser::parameters(const std::string& owner, const char* attribute_target) {
  SharedParameters attributes;
  if (attribute_target)
    if (const auto found = state_.attributes.find(attribute_target); found != state_.attributes.end()) attributes = found->second;
  return {own_parameters(), std::move(attributes), owner, where_, main_file_, state_.space, diagnostics_};
}

// --- Files ---

std::string Parser::included_file() {
  const SourceLocation place = lexer_->place(lexer_->peek());
  const std::string name = string_argument("a file name");
  std::string file = resolve_file(name, place, main_file_);
  std::error_code ignored;
  const std::string canonical = fs::weakly_canonical(file, ignored).string();
  const auto open =
      std::find_if(open_files_.begin(), open_files_.end(), [&](const OpenFile& other) { return other.canonical == canonical; });
  if (open != open_files_.end()) {
    std::string chain;
    for (auto it = open; it != open_files_.end(); ++it) chain += it->name + " includes ";
    throw SyntaxError{place, "recursive " + directive_ + " of " + file + ": " + chain + open->name};
  }
  if (open_files_.size() >= deepest_include)
    throw SyntaxError{place, "more than " + std::to_string(deepest_include) + " files within each other"};
  if (++included_files_ > most_included_files) {
    diagnostics_.error(place, "more than " + std::to_string(most_included_files) + " files are included, one within the other");
    diagnostics_.finish();
  }
  where_ = place;
  open_files_.push_back({file, canonical});
  return file;
}

void Parser::read_included(const std::string& file, Lexer* behind) {
  std::optional<std::string> text;
  try {
    text = read_text(file, where_);
  } catch (const InputError& problem) {
    add_errors(problem, where_, diagnostics_);
  }
  if (text && !files_read_.insert(open_files_.back().canonical).second) included_again_ += text->size();
  if (included_again_ > most_included_again) {
    diagnostics_.error(where_, "the same files are included over and over: more than 256 MiB of text that was read before");
    diagnostics_.finish();
  }
  if (text) parse_file(file, std::move(*text), behind);
  open_files_.pop_back();
}

void Parser::include() {
  const std::string file = included_file();
  read_included(file, lexer_);
}

void Parser::import() {
  const std::string file = included_file();
  const State saved = state_;
  const auto saved_systems = coordinate_systems_;
  const std::size_t outer_floor = std::exchange(block_floor_, blocks_.size());
  read_included(file, nullptr);
  report_unclosed(block_floor_);
  block_floor_ = outer_floor;
  state_ = saved;
  coordinate_systems_ = saved_systems;
}

// --- Blocks ---

void Parser::open_block() { blocks_.push_back({directive_, where_, state_}); }

void Parser::close_block(const std::string& opener) {
  if (blocks_.size() <= block_floor_) throw SyntaxError{where_, directive_ + " without " + opener};
  Block& block = blocks_.back();
  if (block.opener != opener)
    throw SyntaxError{where_, directive_ + " while the " + block.opener + " of " + block.where.to_string() + " is open"};
  state_ = std::move(block.saved);
  blocks_.pop_back();
}

void Parser::report_unclosed(std::size_t first_block) {
  for (; blocks_.size() > first_block; blocks_.pop_back()) {
    if (blocks_.back().opener == "ObjectBegin") object_.reset();
    diagnostics_.error(blocks_.back().where, blocks_.back().opener + " is never closed");
  }
}

void Parser::attribute_begin() {
  if (directive_ == "TransformBegin" && !std::exchange(warned_transform_begin_, true))
    diagnostics_.warning(where_, "TransformBegin is deprecated in pbrt-v4 and does what AttributeBegin does");
  open_block();
}

void Parser::attribute_end() { close_block(directive_ == "AttributeEnd" ? "AttributeBegin" : "TransformBegin"); }

void Parser::object_begin() {
  const std::string name = string_argument("a name");
  if (object_) throw SyntaxError{where_, "ObjectBegin within the ObjectBegin of " + object_where_.to_string()};
  if (const auto [at, fresh] = object_names_.emplace(name, static_cast<std::uint32_t>(scene_.objects.size())); !fresh)
    diagnostics_.error(where_, "the object " + in_quotes(name) + " is defined twice (first at " +
                                   scene_.objects[at->second].where.to_string() + ")");
  open_block();
  object_ = scene_.objects.size();
  object_where_ = where_;
  scene_.objects.push_back({name, {}, where_});
}

void Parser::object_end() {
  close_block("ObjectBegin");
  object_.reset();
}

void Parser::object_instance() {
  const std::string name = string_argument("an object's name");
  if (object_) throw SyntaxError{where_, "ObjectInstance within the ObjectBegin of " + object_where_.to_string()};
  check_place();
  instances_.push_back({name, state_.ctm, where_});
}

void Parser::world_begin() {
  in_world_ = true;
  identity();
  coordinate_systems_["world"] = state_.ctm;
}

// --- The end ---

void Parser::warn_of_kind(const SourceLocation& where, const std::string& message, const std::string& kind) {
  if (const auto found = std::ranges::find(warnings_, kind, &Warning::kind); found != warnings_.end())
    ++found->others;
  else
    warnings_.push_back({where, message, kind});
}

void Parser::log_warnings() {
  for (const Warning& one : warnings_)
    diagnostics_.warning(one.where,
                         one.message + (one.others > 0 ? " (and " + std::to_string(one.others) + " more of this kind)" : ""));
}

void Parser::finish_attributes() {
  // An earlier Attribute counts as used if a later one of the same name that replaced it was used; hence the reverse order.
  for (auto it = all_attributes_.rbegin(); it != all_attributes_.rend(); ++it)
    if ((*it)->replaced_by && (*it)->replaced_by->used) (*it)->used = true;
  for (const auto& parameter : all_attributes_)
    if (parameter->consulted && !parameter->used && !parameter->broken)
      diagnostics_.error(parameter->where, "no statement after this Attribute knows the parameter " + in_quotes(parameter->name));
}

void Parser::resolve_instances() {
  for (const InstanceUse& use : instances_) {
    if (const auto found = object_names_.find(use.name); found != object_names_.end()) {
      scene_.instances.push_back({found->second, use.world_from_object, use.where});
      continue;
    }
    diagnostics_.error(use.where, "the object " + in_quotes(use.name) + " is not defined" + nearest(use.name, object_names_));
  }
}

}  // namespace caplet::pbrt
