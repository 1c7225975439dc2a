// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Photometric files of ANSI/IES LM-63 (docs/formats/ies.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/lights/ies.h"

namespace caplet {

/// Candela of all directions: the numbers of the file times its multiplier and its ballast's factors. Type C, TILT=NONE; what a
/// file leaves to symmetry is filled in. Throws InputError with the place of the first thing wrong.
IesProfile parse_ies(const std::string& name, std::string_view text);
IesProfile read_ies(const std::filesystem::path& path);

}  // namespace caplet
