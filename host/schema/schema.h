// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What there is to say in a statement: the parameters of every material, texture, light, medium, shape, camera, film, filter,
// sampler and integrator, as their models declare them (scene/field.h). `caplet info --parameters`, the library, Python and the
// pages list what is here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "schema/parameter.h"

namespace caplet::schema {

/// The families in the order of the pages: "material", "texture", ...
const std::vector<std::string>& families();

/// The directive of a family in scene files: "LightSource" of "light".
std::string directive_of(std::string_view family);

/// What a statement of an accepted type (import/statement.h) may say; none of an unknown one.
std::vector<Parameter> parameters_of(std::string_view directive, const std::string& type);

}  // namespace caplet::schema
