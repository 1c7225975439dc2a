// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Parses the parameter lists ("type name" values) of pbrt statements.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "import/detail/pbrt/lexer.h"
#include "scene/spectrum.h"

namespace caplet::pbrt {

struct Parameter {
  std::string type,
      name;  // old type names are replaced by the new ones ("point" -> "point3"); no type: any that
             // suits the values
  SourceLocation where;
  std::vector<double>
      numbers;  // integer, float, points, vectors, normal, rgb, blackbody, spectrum (pairs)
  std::vector<std::string> strings;  // string, texture, spectrum (a name or a file)
  std::vector<bool> bools;
  ColorSpace space = ColorSpace::srgb;     // that of the graphics state; the builder sets it
  std::string again;                       // the warning for a duplicate of the same name and type
  bool broken = false;                     // reported already; it counts as given but has no value
  bool used = false;                       // its value was read
  bool consulted = false;                  // of an Attribute: a statement of its target followed
  std::shared_ptr<Parameter> replaced_by;  // of an Attribute: a later one of the same name
};

/// Reads the parameters up to the next directive. Errors of single parameters are reported
/// and the parameter is marked broken.
std::vector<Parameter> parse_parameters(Lexer& statement, Diagnostics& diagnostics);

/// Returns the number of which the count of a known type's values is a multiple: 3 for "point3".
std::size_t values_each(std::string_view type);

}  // namespace caplet::pbrt
