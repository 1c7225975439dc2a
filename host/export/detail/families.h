// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The statements of textures, materials, media, lights and shapes: their parameters are those that the lists of host/scene visit.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "export/detail/names.h"
#include "export/detail/statement.h"
#include "scene/scene.h"

namespace caplet::pbrt_text {

/// No value for a texture that has no statement of its own, as it stands in that of a material.
std::optional<Statement> texture_statement(const Scene& scene, std::uint32_t texture, const Names& names, const Stream& stream);
Statement material_statement(const Scene& scene, std::uint32_t material, const Names& names, const Stream& stream);
Statement medium_statement(const Medium& medium, const std::string& name, const Stream& stream);
Statement light_statement(const Light& light, const Stream& stream);
Statement area_statement(const AreaEmission& emission, const SourceLocation& where, const Stream& stream);

/// What a Shape statement refers to.
struct ShapeReferences {
  const Scene& scene;
  const Names& names;
  std::function<std::string(const Shape&)> operand;  // the object that holds it
};
/// Without what only the graphics state says. `as_operand`: nor what an operand has not.
Statement shape_statement(const Shape& shape, const ShapeReferences& references, bool as_operand = false);

/// Whether a closed shape has hair on it, which importers take for one-sided where nothing is said.
bool is_hair(const Scene& scene, const Shape& shape);

}  // namespace caplet::pbrt_text
