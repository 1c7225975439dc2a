// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Names that pbrt-v3 and pbrt-v4 spell differently: recognises scenes of pbrt-v3 and suggests the
// new names.
#pragma once

#include <string>
#include <string_view>

namespace caplet::pbrt {

/// Returns "pbrt-v3's name for ..." and the like if `name` is pbrt-v3's for a type of `directive`
/// ("Material", "matte"), a directive ("", "WorldEnd") or a parameter type ("type", "color");
/// otherwise empty. The pairs are those of pbrt-v4's own `pbrt
/// --upgrade`.
std::string v3_name(std::string_view directive, std::string_view name);

/// Does the same for the name of a parameter in a statement of `directive`.
std::string v3_parameter(std::string_view directive, std::string_view name);

}  // namespace caplet::pbrt
