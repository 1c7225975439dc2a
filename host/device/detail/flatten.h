// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Puts the files that a kernel text includes into it, so that one string is the whole program and no include path is needed.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace caplet {

/// The text of the file of that path (from kernels/), or nothing when there is none.
using FileReader = std::function<std::optional<std::string>(const std::string& path)>;

/// Replaces every `#include "path"` line of `text` by the flattened text of that file, as often as it is named: include guards
/// are the OpenCL preprocessor's work. `#line` marks name `label` and "kernels/path", so build logs point at the files. Angle
/// includes stay; quoted includes under `#ifdef __cplusplus` become empty lines. Throws std::logic_error with the place for a
/// file that does not exist, a malformed include and files that include each other in a circle.
std::string flatten(const std::string& text, const std::string& label, const FileReader& read);

}  // namespace caplet
