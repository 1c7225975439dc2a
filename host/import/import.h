// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads scene files of every known format into the model. Each format has one file here, one row in
// importers.def and one page in docs/formats.
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

/// The content of a file, not validated yet, with the file's own camera and lights.
struct Imported {
  Imported(Scene of_geometry) : scene(std::move(of_geometry)) {}
  Scene scene;
  bool has_camera = false;   // the file places the camera, or it was already framed
  bool is_lit = false;       // it needs no studio light
  std::uint32_t frames = 1;  // models, frames or records; the option "model" chooses one
};

struct Format {
  std::string name;                     // "pbrt-v4"
  std::vector<std::string> extensions;  // ".pbrt"
  std::vector<std::string> options;     // names of import_option_rows() that it knows
  /// Throws InputError.
  Imported (*import)(const std::filesystem::path& path, const ImageReader& images,
                     const ImportOptions& options);
  // The default for files that do not state it.
  double noise = usual_noise;  // 0: of SamplerSettings
  double least_width = FilmSettings{}.least_width;
};

const std::vector<Format>& formats();

/// Returns whether an XML file with this root element may be of the format, for formats that share
/// an ending.
bool is_its_root(const Format& format, std::string_view root);

/// Imports by extension. The scene is validated; missing camera, light or material get sensible
/// defaults. Throws InputError for a missing, unreadable or wrong file, an unknown extension, or an
/// option that its format does not know.
Scene import_scene(const std::filesystem::path& path, const ImageReader& images,
                   const ImportOptions& options = {});

/// Reads several files of any formats as one scene. Their contents keep their coordinates, and
/// names of shapes begin with that of their file. At most one may bring a camera, whose film,
/// sampler and integrator are then used; without one the camera frames everything, and studio light
/// is added if no file brings light. FILE@translate=X,Y,Z@rotate=DEGREES,X,Y,Z@scale=S moves a
/// file's shapes. An option applies to all files whose format knows it. Throws InputError.
Scene import_scenes(std::span<const std::filesystem::path> paths, const ImageReader& images,
                    const ImportOptions& options = {});

/// Returns the options that the format of at least one of these files knows. Throws InputError for
/// an unknown extension.
std::vector<ImportOptionRow> format_options_of(std::span<const std::filesystem::path> paths);

/// Reads one file and adds no camera or light; `format` overrides the format of its name. Throws
/// InputError.
Imported read_scene(const std::filesystem::path& path, const ImageReader& images,
                    const ImportOptions& options = {}, const Format* format = nullptr);

/// Reads the pbrt text of a scene without content as if it were that of `file`. Throws InputError.
Scene read_pbrt_text(const std::filesystem::path& file, std::string text,
                     const ImageReader& images);

/// Adds the camera and the light that the file lacks (present/present.h).
Scene presented(Imported file);

/// Returns the format of a file by its name, and for .xml by its root element. Throws InputError
/// for an unknown extension.
const Format& format_of(const std::filesystem::path& path);

}  // namespace caplet
