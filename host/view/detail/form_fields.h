// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Fields of forms: the fields of a scene's parts that host/scene's lists visit, with name, kind and
// range.
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

/// Says whether a texture may replace a value.
struct Slot {
  bool is_float = false;
  std::optional<std::uint32_t> texture = {};
  std::size_t before = SIZE_MAX;  // the texture's index must be below this
};

/// Visits each field of a part, and may change it.
class FormFields {
 public:
  virtual ~FormFields() = default;
  virtual void number(const std::string& name, double& value, double low, double high,
                      Slot* slot = nullptr) = 0;
  virtual void whole(const std::string& name, int& value, int low, int high) = 0;
  virtual void choice(const std::string& name, int& value,
                      const std::vector<std::string>& options) = 0;
  virtual void flag(const std::string& name, bool& value) = 0;
  virtual void text(const std::string& name, std::string& value) = 0;
  /// `most`: the greatest allowed value.
  virtual void spectrum(const std::string& name, Spectrum& value, double most,
                        Slot* slot = nullptr) = 0;
  /// A number above 0, or none.
  virtual void option(const std::string& name, std::optional<double>& value) = 0;
  virtual void point(const std::string& name, glm::dvec3& value) = 0;
  /// A direction of unit length.
  virtual void direction(const std::string& name, glm::dvec3& value) = 0;
  /// A file name, which cannot be changed.
  virtual void file(const std::string& name, const std::string& value) = 0;
  virtual void material(const std::string& name, std::uint32_t& value) = 0;
  /// A texture, or none.
  virtual void texture(const std::string& name, Slot& slot) = 0;
};

/// `own`: the index that the part has or will have.
void visit_form(FormFields& fields, Material& material, std::uint32_t own, const Scene& scene);
void visit_form(FormFields& fields, Texture& texture, std::uint32_t own);
void visit_form(FormFields& fields, Light& light);
void visit_form(FormFields& fields, std::optional<AreaEmission>& emission);
void visit_form(FormFields& fields, Shape& shape);
/// Visits the camera (but for its place), the film, the filter, the sampler or the integrator.
void visit_form(FormFields& fields, View& view, FormSubject::Kind kind);

/// Lists the kinds that can be made without an existing part.
std::vector<std::string> new_kinds(FormSubject::Kind what);

/// Makes a part of a kind in the list, with a name that the scene does not have yet. Throws
/// InputError.
Material new_material(const Scene& scene, const Add& add);
Texture new_texture(const Scene& scene, const Add& add);
Light new_light(const Add& add);
Shape new_shape(const Scene& scene, const Add& add);

}  // namespace caplet::view
