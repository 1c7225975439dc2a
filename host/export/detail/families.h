// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes the statements of textures, materials, media, lights and shapes; their parameters are the
// fields of host/scene's lists.
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

/// Returns no value for a texture that a material's statement contains, and that has no statement
/// of its own.
std::optional<Statement> texture_statement(const Scene& scene, std::uint32_t texture,
                                           const Names& names, const Stream& stream);
Statement material_statement(const Scene& scene, std::uint32_t material, const Names& names,
                             const Stream& stream);
Statement medium_statement(const Medium& medium, const std::string& name, const Stream& stream);
Statement light_statement(const Light& light, const Stream& stream);
Statement area_statement(const AreaEmission& emission, const SourceLocation& where,
                         const Stream& stream);

/// What a Shape statement refers to.
struct ShapeReferences {
  const Scene& scene;
  const Names& names;
  /// Returns the object that holds an operand of a csg.
  std::function<std::string(const CsgShape&, std::size_t operand)> operand;
};
/// Leaves out what the graphics state holds. `as_operand`: also what operands cannot have.
Statement shape_statement(const Shape& shape, const ShapeReferences& references,
                          bool as_operand = false);

/// Returns whether a closed shape has hair on it; importers make such a shape one-sided by default.
bool is_hair(const Scene& scene, const Shape& shape);

}  // namespace caplet::pbrt_text
