// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The parser of pbrt-v4 text calls these: one method per directive, in four interfaces. A method
// may throw SyntaxError. The parser then reports it and goes on at the next directive.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "import/detail/pbrt/lexer.h"
#include "import/detail/pbrt/parameter.h"

namespace caplet::pbrt {

/// The directive that is read, and its place.
struct Statement {
  std::string_view directive;
  SourceLocation where;

  /// Returns how messages name the statement: Shape "sphere".
  std::string of(const std::string& type) const {
    return std::string(directive) + " " + in_quotes(type);
  }
};

/// A word or string of a statement, with its place.
struct Word {
  std::string text;
  SourceLocation where;
};

using ParameterList = std::vector<Parameter>;

/// Directives that set how the scene is rendered.
class OptionTarget {
 public:
  virtual ~OptionTarget() = default;
  virtual void accelerator(const Statement& at, const std::string& type, ParameterList own) = 0;
  virtual void camera(const Statement& at, const std::string& type, ParameterList own) = 0;
  virtual void film(const Statement& at, const std::string& type, ParameterList own) = 0;
  virtual void integrator(const Statement& at, const std::string& type, ParameterList own) = 0;
  /// `value` is valid during the call alone.
  virtual void option(const Statement& at, const std::string& name, const Token& value) = 0;
  virtual void pixel_filter(const Statement& at, const std::string& type, ParameterList own) = 0;
  virtual void sampler(const Statement& at, const std::string& type, ParameterList own) = 0;
};

/// Directives that change the current transform.
class TransformTarget {
 public:
  virtual ~TransformTarget() = default;
  virtual void active_transform(const Statement& at, const Word& which) = 0;
  virtual void concat_transform(const Statement& at, const glm::dmat4& matrix) = 0;
  virtual void coord_sys_transform(const Statement& at, const Word& name) = 0;
  virtual void coordinate_system(const Statement& at, const Word& name) = 0;
  virtual void identity(const Statement& at) = 0;
  virtual void inverse_transform(const Statement& at, const glm::dmat4& matrix) = 0;
  virtual void look_at(const Statement& at, const glm::dvec3& eye, const glm::dvec3& target,
                       const glm::dvec3& up) = 0;
  virtual void rotate(const Statement& at, double degrees, const glm::dvec3& axis) = 0;
  virtual void scale(const Statement& at, const glm::dvec3& factors) = 0;
  virtual void transform(const Statement& at, const glm::dmat4& matrix) = 0;
  virtual void transform_times(const Statement& at, double start, double end) = 0;
  virtual void translate(const Statement& at, const glm::dvec3& offset) = 0;
};

/// Parses the text of another file in place of the statement.
using ParseText = std::function<void(const std::string& file, std::string text)>;

/// Directives that open and close blocks, change the other graphics state, or read other files.
class StateTarget {
 public:
  virtual ~StateTarget() = default;
  virtual void attribute(const Statement& at, const Word& target, ParameterList own) = 0;
  virtual void attribute_begin(const Statement& at) = 0;
  virtual void attribute_end(const Statement& at) = 0;
  virtual void color_space(const Statement& at, const Word& name) = 0;
  /// `parse` reads on in a scope of its own: a statement does not continue after it.
  virtual void import(const Statement& at, const Word& file, const ParseText& parse) = 0;
  virtual void include(const Statement& at, const Word& file, const ParseText& parse) = 0;
  virtual void object_begin(const Statement& at, const std::string& name) = 0;
  virtual void object_end(const Statement& at) = 0;
  virtual void object_instance(const Statement& at, const std::string& name) = 0;
  virtual void reverse_orientation(const Statement& at) = 0;
  virtual void transform_begin(const Statement& at) = 0;
  virtual void transform_end(const Statement& at) = 0;
  virtual void world_begin(const Statement& at) = 0;
};

/// Directives that say what the scene contains.
class SceneTarget {
 public:
  virtual ~SceneTarget() = default;
  virtual void area_light_source(const Statement& at, const std::string& type,
                                 ParameterList own) = 0;
  virtual void light_source(const Statement& at, const std::string& type, ParameterList own) = 0;
  virtual void make_named_material(const Statement& at, const std::string& name,
                                   ParameterList own) = 0;
  virtual void make_named_medium(const Statement& at, const std::string& name,
                                 ParameterList own) = 0;
  virtual void material(const Statement& at, const std::string& type, ParameterList own) = 0;
  /// `outside`: no value where one name stands for both sides.
  virtual void medium_interface(const Statement& at, const Word& inside,
                                const std::optional<Word>& outside) = 0;
  virtual void named_material(const Statement& at, const Word& name) = 0;
  virtual void shape(const Statement& at, const std::string& type, ParameterList own) = 0;
  virtual void texture(const Statement& at, const std::string& name, const Word& kind,
                       const Word& texture_class, ParameterList own) = 0;
};

using Target = std::tuple<OptionTarget&, TransformTarget&, StateTarget&, SceneTarget&>;

}  // namespace caplet::pbrt
