// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What pbrt-v3 called otherwise than pbrt-v4: scenes in its language are told apart, and the new names said.
#pragma once

#include <string>
#include <string_view>

namespace caplet::pbrt {

/// "pbrt-v3's name for ..." and the like where `name` is pbrt-v3's for a type of `directive` ("Material", "matte"), a directive
/// ("", "WorldEnd") or the type of a parameter ("type", "color"); empty where it is not. The pairs are those of pbrt-v4's own
/// `pbrt --upgrade`.
std::string v3_name(std::string_view directive, std::string_view name);

/// The same for the name of a parameter in a statement of `directive`.
std::string v3_parameter(std::string_view directive, std::string_view name);

}  // namespace caplet::pbrt
