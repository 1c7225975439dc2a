// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Directives that set options, transforms, materials, lights and shapes.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "base/reading.h"
#include "base/spelling.h"
#include "import/detail/pbrt_lights.h"
#include "import/detail/pbrt_materials.h"
#include "import/detail/pbrt_names.h"
#include "import/detail/pbrt_options.h"
#include "import/detail/pbrt_parser.h"
#include "import/detail/pbrt_shapes.h"
#include "import/detail/pbrt_v3.h"
#include "scene/edit.h"
#include "scene/transform.h"

namespace caplet::pbrt {

namespace {

constexpr std::size_t most_attributes = 256;  // Attributes of different names; no statement has as many parameters

}  // namespace

// --- Options ---

void Parser::accelerator() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type));
  if (check_name("Accelerator", type, where_, diagnostics_)) check_accelerator(type, given);
}

void Parser::camera() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type));
  has_camera_ = true;
  check_place();
  coordinate_systems_["camera"] = inverse_of_transform();
  if (check_name("Camera", type, where_, diagnostics_)) set_camera(type, given, inverse_of_transform(), scene_);
  scene_.camera.medium = state_.media.outside;
}

void Parser::film() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type));
  if (check_name("Film", type, where_, diagnostics_)) set_film(type, given, state_.space, scene_, &images_);
}

void Parser::integrator() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type));
  if (check_name("Integrator", type, where_, diagnostics_)) set_integrator(type, given, scene_);
}

void Parser::pixel_filter() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type));
  if (check_name("PixelFilter", type, where_, diagnostics_)) set_filter(type, given, scene_);
}

void Parser::sampler() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type));
  if (check_name("Sampler", type, where_, diagnostics_)) sampler_seed_ = set_sampler(type, given, scene_);
}

void Parser::option() {
  std::string name = string_argument("a name");
  if (const std::size_t blank = name.find_last_of(" \t"); blank != std::string::npos) name = name.substr(blank + 1);
  const bool bracket = lexer_->peek().kind == Token::Kind::open;
  if (bracket) lexer_->next();
  const Token value = lexer_->next();
  if (value.kind != Token::Kind::word && value.kind != Token::Kind::string)
    throw SyntaxError{lexer_->place(value), "Option needs a value, found " + in_quotes(value.text)};
  if (bracket && lexer_->next().kind != Token::Kind::close) throw SyntaxError{where_, "Option takes one value"};
  if (!check_name("Option", name, where_, diagnostics_)) return;
  if (const auto seed = set_option(name, value, *lexer_, diagnostics_)) option_seed_ = seed;
}

void Parser::color_space() {
  const SourceLocation place = lexer_->place(lexer_->peek());
  const std::string name = string_argument("a name");
  if (!check_name("ColorSpace", name, place, diagnostics_)) return;
  state_.space = static_cast<ColorSpace>(std::ranges::find(color_space_names, name) - color_space_names.begin());
}

// --- Transforms ---

void Parser::multiply(const glm::dmat4& matrix) {
  if (!has_inverse(matrix)) {
    // As in pbrt-v4, a singular transform is an error only where something is placed with it.
    if (!state_.flat) state_.flat = {where_, directive_ + " has no inverse"};
    return;
  }
  if (!is_affine(matrix) && !state_.skewed)
    state_.skewed = {where_, directive_ + " is not affine (its last row must be 0 0 0 1)"};
  set_transform(state_.ctm * matrix);
}

void Parser::set_transform(const glm::dmat4& ctm) {
  state_.ctm = ctm;
  state_.inverse.reset();
}

glm::dmat4 Parser::inverse_of_transform() const { return state_.inverse ? *state_.inverse : glm::inverse(state_.ctm); }

void Parser::active_transform() {
  const Token token = lexer_->next();
  check_name("ActiveTransform", std::string(token.text), lexer_->place(token), diagnostics_);
}

void Parser::concat_transform() { multiply(matrix_argument()); }

void Parser::check_place() {
  for (const std::optional<Flat>& bad : {state_.flat, state_.skewed})
    if (bad) diagnostics_.error(bad->where, bad->what, bad->where.to_string());
}

/// An infinite light has no position. As in pbrt-v4, directions are mapped by the inverse, whose last row they do not use.
glm::dmat4 Parser::place_of_light(const std::string& type) {
  if (type != "infinite" || !state_.skewed || state_.flat) {
    check_place();
    return state_.ctm;
  }
  return glm::dmat4(glm::inverse(glm::dmat3(inverse_of_transform())));
}

void Parser::transform() {
  const glm::dmat4 matrix = matrix_argument();
  identity();
  multiply(matrix);
  if (state_.ctm == matrix) state_.ctm = matrix;  // keeps the signs of zeros
}

void Parser::inverse_transform() {
  const glm::dmat4 matrix = matrix_argument();
  if (!has_inverse(matrix)) {
    diagnostics_.error(where_, directive_ + " has no inverse");
    return;
  }
  identity();
  state_.ctm = glm::inverse(matrix);
  state_.inverse = matrix;
}

void Parser::identity() {
  set_transform(glm::dmat4(1));
  state_.flat.reset();
  state_.skewed.reset();
}

void Parser::coordinate_system() {
  check_place();
  coordinate_systems_[string_argument("a name")] = state_.ctm;
}

void Parser::coord_sys_transform() {
  const SourceLocation place = lexer_->place(lexer_->peek());
  const std::string name = string_argument("a name");
  if (const auto found = coordinate_systems_.find(name); found != coordinate_systems_.end()) {
    set_transform(found->second);
    state_.flat.reset();
    state_.skewed.reset();
    return;
  }
  diagnostics_.error(place, "unknown coordinate system " + in_quotes(name) + nearest(name, coordinate_systems_));
}

void Parser::look_at() {
  const glm::dvec3 eye = vector_argument(), target = vector_argument(), up = vector_argument();
  if (const auto world_from_camera = camera_looking(eye, target, up))
    set_transform(state_.ctm * glm::affineInverse(*world_from_camera));
  else
    diagnostics_.error(where_, "LookAt has no direction (the points coincide, or up lies along the view)");
}

void Parser::rotate() {
  const double degrees = number_argument();
  const glm::dvec3 axis = vector_argument();
  if (glm::length(axis) > 0)
    multiply(glm::rotate(glm::dmat4(1), degrees * glm::pi<double>() / 180, glm::normalize(axis)));
  else
    diagnostics_.error(where_, "Rotate has no axis");
}

void Parser::scale() { multiply(glm::scale(glm::dmat4(1), vector_argument())); }

void Parser::translate() { multiply(glm::translate(glm::dmat4(1), vector_argument())); }

void Parser::transform_times() {
  number_argument();
  number_argument();
}

void Parser::reverse_orientation() { state_.reverse_orientation = !state_.reverse_orientation; }

// --- Materials, textures, media ---

void Parser::attribute() {
  static const std::vector<std::string> targets = {"light", "material", "medium", "shape", "texture"};
  const SourceLocation place = lexer_->place(lexer_->peek());
  const std::string target = string_argument("a target");
  std::vector<Parameter> given = own_parameters();
  if (std::find(targets.begin(), targets.end(), target) == targets.end()) {
    diagnostics_.error(place, "unknown Attribute target " + in_quotes(target) + "; the nearest known name is \"" +
                                  nearest_name(target, targets) + "\"");
    return;
  }
  SharedParameters& current = state_.attributes[target];
  for (Parameter& parameter : given) {
    all_attributes_.push_back(std::make_shared<Parameter>(std::move(parameter)));
    const auto& fresh = all_attributes_.back();
    const auto same = [&](const auto& other) { return other->name == fresh->name; };
    if (const auto found = std::find_if(current.begin(), current.end(), same); found != current.end()) {
      (*found)->replaced_by = fresh;
      *found = fresh;
    } else if (current.size() < most_attributes) {
      current.push_back(fresh);
    } else {
      throw SyntaxError{fresh->where, "more than " + std::to_string(most_attributes) + " attributes of one target"};
    }
  }
}

void Parser::material() {
  std::string type = string_argument("a type");
  if (type.empty() || type == "none") {
    const std::string old = "Material " + in_quotes(type) + " is the old name of \"interface\"";
    warn_of_kind(where_, old, old);
    type = "interface";
  }
  Parameters given = parameters(owner(type), "material");
  const Refusal refusal = refusal_of("Material", type);
  if (!refusal.is_known) {
    diagnostics_.error(where_, refusal.text, refusal.text);
    state_.material = 0;
    return;
  }
  state_.material = static_cast<std::uint32_t>(uses_.size());
  uses_.push_back({materials_.size(), {}, where_});
  materials_.push_back({type, {}, std::move(given), refusal.text, where_});
}

void Parser::make_named_material() {
  const std::string name = string_argument("a name");
  Parameters given = parameters(owner(name), "material");
  const bool has_type = given.has("type");
  const std::string type = given.text("type", "");
  if (const auto found = named_materials_.find(name); found != named_materials_.end()) {
    diagnostics_.error(where_, "the material " + in_quotes(name) + " is defined twice");
    return;
  }
  named_materials_.emplace(name, materials_.size());
  if (!has_type) given.error("\"string type\" is missing");
  const Refusal refusal = has_type ? refusal_of("Material", type) : Refusal{};
  const SourceLocation where = given.where("type");
  if (!refusal.is_known) diagnostics_.error(where, refusal.text, refusal.text);
  materials_.push_back({refusal.is_known ? type : "", name, std::move(given), refusal.text, where});
}

std::uint32_t Parser::use_of_name(const std::string& name, const SourceLocation& where) {
  const auto [at, fresh] = uses_by_name_.emplace(name, static_cast<std::uint32_t>(uses_.size()));
  if (fresh) uses_.push_back({std::nullopt, name, where});
  return at->second;
}

void Parser::named_material() {
  const SourceLocation place = lexer_->place(lexer_->peek());
  state_.material = use_of_name(string_argument("a name"), place);
}

TextureContext Parser::texture_context() {
  return {state_.ctm, inverse_of_transform(),
          [this](Parameters& parameters, const char* name, const ImageEncoding& encoding, std::string& problem) {
            return texture_image(parameters, name, encoding, problem);
          }};
}

std::shared_ptr<const TextureImage> Parser::texture_image(Parameters& parameters, const char* name, const ImageEncoding& encoding,
                                                          std::string& problem) {
  const std::string given = parameters.text(name, "");
  const std::string file = resolve_file(given, parameters.where(name), parameters.main_file());
  std::error_code ignored;
  if (given.empty() || !is_file(file, parameters.where(name))) {
    problem = "no such file " + in_quotes(file);
    return nullptr;
  }
  const auto [found, fresh] =
      texture_images_.try_emplace({std::filesystem::weakly_canonical(file, ignored).string(), encoding}, nullptr);
  if (fresh || !found->second) try {
      found->second = std::make_shared<TextureImage>(images_.read_texture(file, encoding));
    } catch (const InputError& error) {
      problem = error.messages().front();
    }
  return found->second;
}

void Parser::texture() {
  const std::string name = string_argument("a name");
  const SourceLocation kind_place = lexer_->place(lexer_->peek());
  const std::string kind = string_argument("\"float\" or \"spectrum\"");
  const SourceLocation class_place = lexer_->place(lexer_->peek());
  const std::string texture_class = string_argument("a class");
  Parameters given = parameters(owner(name), "texture");
  if (state_.skewed) check_place();
  if (kind != "float" && kind != "spectrum") {
    const std::string old = v3_name("Texture", kind), said = "a texture is \"float\" or \"spectrum\", not " + in_quotes(kind);
    diagnostics_.error(kind_place, said + (old.empty() ? "" : ": that is " + old), said);
    return;
  }
  bool known = false;
  for (const NameTable& table : name_tables())
    if (table.directive == "Texture")
      known = std::find(table.refused.begin(), table.refused.end(), texture_class) != table.refused.end() ||
              check_name("Texture", texture_class, class_place, diagnostics_);
  if (!known) return;
  TextureValue value = make_texture(name, kind, texture_class, given, textures_, texture_context(), scene_);
  if (!textures_.add(name, std::move(value))) diagnostics_.error(where_, "the texture " + in_quotes(name) + " is defined twice");
}

// --- Lights and shapes ---

void Parser::light_source() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type), "light");
  const glm::dmat4 world_from_light = place_of_light(type);
  if (!check_name("LightSource", type, where_, diagnostics_)) return;
  if (auto light = make_light(type, given, world_from_light, light_files_)) scene_.lights.push_back(std::move(*light));
}

void Parser::area_light_source() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type), "light");
  if (check_name("AreaLightSource", type, where_, diagnostics_)) state_.emission = make_area_emission(given, light_files_);
}

void Parser::shape() {
  const std::string type = string_argument("a type");
  Parameters given = parameters(owner(type), "shape");
  check_place();
  if (!check_name("Shape", type, where_, diagnostics_)) return;
  if (is_file_shape(type)) return shapes_of_file(type, given);
  const auto by_name = [this](const std::string& name, const SourceLocation& where) { return use_of_name(name, where); };
  const auto finished = [this](const std::string& name, std::string& problem) { return finished_object(name, problem); };
  Shape shape = make_shape(type, given, state_.material, {textures_, by_name, finished});
  shape.world_from_object = state_.ctm;
  shape.reverse_orientation = state_.reverse_orientation;
  shape.emission = state_.emission;
  shape.media = state_.media;
  if (!shape.one_sided && given.has("onesided")) said_two_sided_.insert(shape.where.to_string());
  (object_ ? scene_.objects[*object_].shapes : scene_.shapes).push_back(std::move(shape));
}

const Object* Parser::finished_object(const std::string& name, std::string& problem) const {
  const auto found = object_names_.find(name);
  if (found == object_names_.end()) {
    problem = "names the object " + in_quotes(name) + ", which is not defined before this" + nearest(name, object_names_);
    return nullptr;
  }
  const Object& object = scene_.objects[found->second];
  if (object_ != found->second) return &object;
  problem = "names the object " + in_quotes(name) + ", which is being defined (" + object.where.to_string() +
            "): a csg cannot hold itself";
  return nullptr;
}

}  // namespace caplet::pbrt
