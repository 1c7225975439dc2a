// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spectrum files (.spd): wavelengths (nm) and values alternate; `#` starts a comment.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "scene/spectrum.h"

namespace caplet::pbrt {

/// Throws InputError with the place in the file, or at `where` when the file cannot be read.
SampledSpectrum read_spectrum_file(const std::filesystem::path& path, const SourceLocation& where);
SampledSpectrum parse_spectrum_text(const std::string& file, std::string text);

}  // namespace caplet::pbrt
