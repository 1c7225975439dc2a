// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The parameters of every material, texture, light, medium, shape, camera, film, filter, sampler
// and integrator, as their models declare them (scene/field.h). `caplet info --parameters`, the
// library, Python and the documentation list these.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "schema/parameter.h"

namespace caplet::schema {

/// Lists the families in the order of the documentation: "material", "texture", ...
const std::vector<std::string>& families();

/// Returns the directive of a family in scene files: "LightSource" of "light".
std::string directive_of(std::string_view family);

/// Returns the parameters that pbrt-v4's integrators of this type have, and that have no effect.
std::vector<const char*> ignored_integrator_parameters(std::string_view type);

/// Returns the parameters of a statement of an accepted type (import/statement.h); none for an
/// unknown type.
std::vector<Parameter> parameters_of(std::string_view directive, const std::string& type);

}  // namespace caplet::schema
