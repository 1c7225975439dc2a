// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads the parameters of pbrt statements with type checks. A parameter that a statement does not
// ask for is an error.
#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "import/detail/pbrt/parameter.h"
#include "scene/scene.h"
#include "scene/spectrum.h"

namespace caplet::pbrt {

enum class SpectrumUse { albedo, unbounded, illuminant };

/// The value of a Texture statement: a constant, a texture of the scene, or the reason why it
/// cannot be rendered.
struct TextureValue {
  bool is_float = false;
  double number = 0;
  Spectrum spectrum;
  std::optional<std::uint32_t> texture;  // index into Scene::textures
  std::string refusal;
};
/// Textures by name. A texture of floats and one of spectra may share a name.
class TextureTable {
 public:
  /// Returns false and adds nothing if one of that name and kind exists.
  bool add(const std::string& name, TextureValue value) {
    return of(value.is_float).emplace(name, std::move(value)).second;
  }
  /// Returns the texture of the kind, else that of the other kind, else null.
  const TextureValue* find(const std::string& name, bool is_float) const {
    for (const bool kind : {is_float, !is_float})
      if (const auto found = of_[kind ? 1 : 0].find(name); found != of_[kind ? 1 : 0].end())
        return &found->second;
    return nullptr;
  }

 private:
  std::map<std::string, TextureValue>& of(bool is_float) { return of_[is_float ? 1 : 0]; }
  std::map<std::string, TextureValue> of_[2];
};

/// FinishedObject is an object that a csg may name. Shapes of it that move are not in `object`.
struct FinishedObject {
  struct MovingShape {
    const Shape* shape;
    const TransformKeys* motion;
  };
  const Object* object = nullptr;
  std::vector<MovingShape> moving = {};
};

/// Finds a finished object by its name. Returns one without an object, with the reason in
/// `problem`, if there is none.
using ObjectLookup = std::function<FinishedObject(const std::string& name, std::string& problem)>;

using SharedParameters = std::vector<std::shared_ptr<Parameter>>;

/// Adds the errors of a file that is named at `where`; each line has both places.
void add_errors(const InputError& problem, const SourceLocation& where, Diagnostics& diagnostics);

/// Resolves a file name of a statement: beside the statement's file, else beside the scene's main
/// file.
std::string resolve_file(const std::string& name, const SourceLocation& where,
                         const std::string& main_file);

/// The parameters of one statement. `main_file` must outlive them; `owner` names the statement in
/// messages (`Shape "sphere"`). A missing parameter gives the fallback; a wrong one reports an
/// error and gives the fallback. The names passed in must be literals, because they are kept by
/// reference.
class Parameters {
 public:
  Parameters(std::vector<Parameter> own, SharedParameters attributes, std::string owner,
             SourceLocation where, const std::string& main_file, ColorSpace space,
             Diagnostics& diagnostics);

  bool has(std::string_view name);
  double number(std::string_view name, double fallback);
  int integer(std::string_view name, int fallback);
  bool boolean(std::string_view name, bool fallback);
  std::string text(std::string_view name, const std::string& fallback);
  glm::dvec3 point(std::string_view name, const glm::dvec3& fallback);
  glm::dvec3 vector(std::string_view name, const glm::dvec3& fallback);
  /// Returns all values of a parameter whose type is one of `types`; null when it is missing.
  const Parameter* values(std::string_view name, std::initializer_list<std::string_view> types);
  std::optional<Spectrum> spectrum(std::string_view name, SpectrumUse use,
                                   const TextureTable* textures = nullptr);
  /// Returns the texture that a parameter names, if the scene has it and it is of floats or spectra
  /// as requested.
  std::optional<std::uint32_t> texture(std::string_view name, bool is_float,
                                       const TextureTable& textures);
  /// Reads a float or a constant texture of floats.
  double number_or_texture(std::string_view name, double fallback, const TextureTable& textures);
  /// Marks a parameter as known and without effect here.
  void ignore(std::string_view name);
  /// Reports every parameter that was not asked for, with the nearest name that was.
  void finish();
  /// Returns the names that were asked for so far, in order; some occur more than once.
  std::vector<std::string> asked() const { return {asked_.begin(), asked_.end()}; }

  /// `kind` is as in Diagnostics::error.
  void error(std::string_view name, const std::string& message, const std::string& kind = {});
  void error(const std::string& message) { diagnostics_->error(where_, owner_ + ": " + message); }
  const SourceLocation& where() const { return where_; }
  SourceLocation where(std::string_view name) const;
  const std::string& owner() const { return owner_; }
  const std::string& main_file() const { return *main_file_; }
  /// Returns the colour space at the statement.
  ColorSpace space() const { return space_; }
  Diagnostics& diagnostics() { return *diagnostics_; }
  /// Sends further errors to `diagnostics`.
  void report_to(Diagnostics& diagnostics) { diagnostics_ = &diagnostics; }

 private:
  Parameter* find(std::string_view name);

  std::vector<Parameter> own_;
  SharedParameters attributes_;
  std::string owner_;
  SourceLocation where_;
  const std::string* main_file_;
  ColorSpace space_;
  Diagnostics* diagnostics_;
  std::vector<std::string_view> asked_;
};

}  // namespace caplet::pbrt
