// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads capsules in bulk from text, one per line (docs/formats/capsules.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "scene/scene.h"

namespace caplet {

/// Finds the material for a name. It is called once per distinct name, in the order of first use,
/// with the place of that use. Capsules that name no material ask for "". It may throw InputError.
using MaterialIndex = std::function<std::uint32_t(const std::string&, const SourceLocation&)>;

/// Reads a `.capsules` file: `<Ax, Ay, Az> <Bx, By, Bz> radius [radius2] [material]` per line.
/// Lengths are scene units. `materials` of the result is empty, and `material_index` never called,
/// when no line names one. The result does not depend on the number of threads. Throws InputError
/// (file:line:column, up to 20 at once) for a missing, empty or wrong file.
CapsulesShape read_capsules(const std::filesystem::path& path, const MaterialIndex& material_index);

}  // namespace caplet
