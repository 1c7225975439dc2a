// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The importers behind registry.cpp, one a format. Each returns a scene that is complete but not yet validated, and throws
// InputError with the file's places.
#pragma once

#include <filesystem>

#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// pbrt-v4 scene text, plain or gzipped (docs/formats/pbrt.md).
Scene import_pbrt(const std::filesystem::path& path, const ImageReader& images);
/// SWC neuron morphologies (docs/formats/swc.md).
Scene import_swc(const std::filesystem::path& path, const ImageReader& images);
/// A bare .capsules file (docs/formats/capsules.md).
Scene import_capsules_file(const std::filesystem::path& path, const ImageReader& images);

}  // namespace caplet
