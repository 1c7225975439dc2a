// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads photometric files of ANSI/IES LM-63 (docs/formats/ies.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/lights/ies.h"

namespace caplet {

/// Returns the candela in all directions: the file's numbers times its multiplier and ballast
/// factors. Reads type C with TILT=NONE, and fills in the directions that a file leaves to
/// symmetry. Throws InputError at the first error.
IesProfile parse_ies(const std::string& name, std::string_view text);
IesProfile read_ies(const std::filesystem::path& path);

}  // namespace caplet
