// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads scene files of every known format into the model. A format is one file here, one row in importers.def and one page in
// docs/formats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "import/import_options.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// What a file holds: not validated yet, camera and light as the file has them.
struct Imported {
  Imported(Scene of_geometry) : scene(std::move(of_geometry)) {}
  Scene scene;
  bool has_camera = false;   // the file says where the camera is, or how it was found
  bool is_lit = false;       // needs no studio light
  std::uint32_t frames = 1;  // models, frames or records, of which the option "model" chooses one
};

struct Format {
  std::string name;                     // "pbrt-v4"
  std::vector<std::string> extensions;  // ".pbrt"
  std::vector<std::string> options;     // names of those in import_options.def that it knows
  /// Throws InputError.
  Imported (*import)(const std::filesystem::path& path, const ImageReader& images, const ImportOptions& options);
  // Of pictures of files that say nothing of it.
  int samples_per_pixel = SamplerSettings{}.samples_per_pixel;
  double least_width = FilmSettings{}.least_width;
};

const std::vector<Format>& formats();

/// Whether an XML file with this root element may be the format's, of those that share an ending.
bool is_its_root(const Format& format, std::string_view root);

/// Imports by extension. The scene is validated; a file that says nothing of camera, light or material has good ones.
/// Throws InputError for a missing, unreadable or wrong file, an unknown extension, or an option that says nothing to its format.
Scene import_scene(const std::filesystem::path& path, const ImageReader& images, const ImportOptions& options = {});

/// Several files as one scene, whatever their formats: what they hold stands where each of them says, and names of shapes begin
/// with that of their file. One of them at most may bring a camera, whose film, sampler and integrator count as well; without one
/// the camera frames all of it, and studio light is added where none of them brings light. An option goes to all files whose
/// format knows it. Throws InputError.
Scene import_scenes(std::span<const std::filesystem::path> paths, const ImageReader& images, const ImportOptions& options = {});

/// One file, without camera and light for what brings none; `format`: which it has whatever its name. Throws InputError.
Imported read_scene(const std::filesystem::path& path, const ImageReader& images, const ImportOptions& options = {},
                    const Format* format = nullptr);

/// Gives a scene the camera and the light that its file does not bring (present/present.h).
Scene presented(Imported file);

/// The format of a file, by its name, and of .xml by its root element. Throws InputError for an unknown extension.
const Format& format_of(const std::filesystem::path& path);

}  // namespace caplet
