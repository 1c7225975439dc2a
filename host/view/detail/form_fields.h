// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The fields of forms: what of a scene's parts the lists of host/scene visit, by name, kind and range.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/edit.h"
#include "scene/scene.h"
#include "view/parts.h"

namespace caplet::view {

/// Where a texture may stand in place of a value.
struct Slot {
  bool is_float = false;
  std::optional<std::uint32_t> texture = {};
  std::size_t before = SIZE_MAX;  // the texture's index is below this
};

/// Sees each field of a part, and may change it.
class FormFields {
 public:
  virtual ~FormFields() = default;
  virtual void number(const std::string& name, double& value, double low, double high, Slot* slot = nullptr) = 0;
  virtual void whole(const std::string& name, int& value, int low, int high) = 0;
  virtual void choice(const std::string& name, int& value, const std::vector<std::string>& options) = 0;
  virtual void flag(const std::string& name, bool& value) = 0;
  virtual void text(const std::string& name, std::string& value) = 0;
  /// `most`: of its values.
  virtual void spectrum(const std::string& name, Spectrum& value, double most, Slot* slot = nullptr) = 0;
  /// Above 0, or none.
  virtual void option(const std::string& name, std::optional<double>& value) = 0;
  virtual void point(const std::string& name, glm::dvec3& value) = 0;
  /// Of unit length.
  virtual void direction(const std::string& name, glm::dvec3& value) = 0;
  /// A file's name, which stays.
  virtual void file(const std::string& name, const std::string& value) = 0;
  virtual void material(const std::string& name, std::uint32_t& value) = 0;
  /// A texture, or none.
  virtual void texture(const std::string& name, Slot& slot) = 0;
};

/// `own`: the index that it has or is to have.
void visit_form(FormFields& fields, Material& material, std::uint32_t own, const Scene& scene);
void visit_form(FormFields& fields, Texture& texture, std::uint32_t own);
void visit_form(FormFields& fields, Light& light);
void visit_form(FormFields& fields, std::optional<AreaEmission>& emission);
void visit_form(FormFields& fields, Shape& shape);
/// Of the film, the filter, the sampler or the integrator.
void visit_form(FormFields& fields, ViewEdit& view, Part::Kind kind);

/// What a list calls its rows, those alone that can be made out of nothing.
std::vector<std::string> new_kinds(Part::Kind what);

/// A part of a kind that the list knows. Throws InputError. Names are those that the scene has not yet.
Material new_material(const Scene& scene, const Add& add);
Texture new_texture(const Scene& scene, const Add& add);
Light new_light(const Add& add);
Shape new_shape(const Scene& scene, const Add& add);

}  // namespace caplet::view
