// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Options of several values, and the changes that they make to a scene.
#pragma once

#include <CLI/App.hpp>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "device/device.h"
#include "film/layers.h"
#include "import/import_options.h"
#include "scene/scene.h"
#include "table/ray_file.h"

namespace caplet::cli {

struct ImageSize {
  int width = 0, height = 0;
};

/// Returns the path of an output; "-" is the standard output.
std::filesystem::path output_named(const std::string& text);

/// Parses "960x540": two integers from 1, at most 2^28 pixels in all. Throws InputError that names
/// --size.
ImageSize parse_size(const std::string& text);

/// Parses "x0,y0,x1,y1" in pixels from the top left, x1 and y1 excluded. Throws InputError that
/// names --crop.
std::array<int, 4> parse_crop(const std::string& text);

/// Parses "X,Y": a pixel of the full image, from the top left. Throws InputError that names
/// --pixel.
std::array<int, 2> parse_pixel(const std::string& text);

/// Parses "ox,oy,oz,dx,dy,dz": origin and direction (of any length). Throws InputError that names
/// --ray.
RayNumbers parse_ray(const std::string& text);

/// Returns the layers to write: the default ones without `list`; "none", or some of layer_rows'
/// options and "all" (Layers::all) separated by commas; and the variance if requested. Throws
/// InputError that names --layers.
Layers parse_layers(const std::optional<std::string>& list, bool variance);

/// Adds an option --NAME for each of import_option_rows, stored in `options` if given. The option
/// SCENE must precede them.
void add_import_options(CLI::App& command, ImportOptions& options);

/// Returns the extensions of all scene formats, for help: ".pbrt, .swc, ...".
std::string scene_extensions();

/// Returns the defaults of pictures if neither the scene nor the user sets them, for help: samples
/// per pixel of all formats ("16, 64 of swc"), least widths of capsules, and the size.
std::string usual_noise_text();
/// Parses a positive time as seconds: "90", "90s", "5m", "1h30m". Throws InputError that names the
/// option.
double parse_seconds(const std::string& option, const std::string& text);
/// Parses "5%" or "0.05". Throws InputError that names --noise.
double parse_noise(const std::string& text);
std::string usual_least_width();
std::string usual_size();

/// Adds the argument SCENE: one file, or several that are joined to one scene.
CLI::Option* add_scene_files(CLI::App& command, std::vector<std::string>& scenes);
/// Calls import_scenes (import/import.h).
Scene import_files(const std::vector<std::string>& scenes, const ImportOptions& options);
/// Returns their names for messages and metadata, separated by blanks.
std::string scene_names(const std::vector<std::string>& scenes);

/// Calls `work`; an InputError that it throws then names `flag`.
template <class Work>
auto with_flag(const char* flag, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(SourceLocation{flag}, error.what());
  }
}

/// Calls `choose`, which returns a device or its number. Errors of the choice then name --device.
template <class Choose>
auto with_device_flag(const Choose& choose) {
  try {
    return choose();
  } catch (const UnknownDevice& error) {
    throw InputError(SourceLocation{"--device"}, error.what());
  } catch (const NoDevice& error) {
    throw RunError(std::string("--device: ") + error.what() +
                   "; `caplet doctor` tells what is missing");
  }
}

/// Call Device::choose and choose_several.
Device choose_device(const std::string& choice, Encoding encoding);
std::vector<Device> choose_devices(const std::string& choice, Encoding encoding);

/// Add `--device`, which chooses one device, or several.
void add_device(CLI::App& command, std::string& choice);
void add_devices_option(CLI::App& command, std::string& choice);

/// Returns the names of all layers, for help: "Z, albedo, ...".
std::string layer_names();

/// Adds `--encoding`, which forces the way that kernels traverse the tree.
void add_encoding(CLI::App& command, Encoding& encoding);

/// The settings that the command line overrides.
struct Overrides {
  std::optional<ImageSize> size;
  std::optional<std::array<int, 4>> crop;  // x0, y0, x1, y1
  std::optional<int> samples_per_pixel, max_depth;
  std::optional<std::uint32_t> seed;
  std::optional<double> clamp;  // film.max_component_value; 0: none
  bool denoise = false;         // true: film.denoise
  std::optional<int> matte_levels;
};

/// Applies the settings. A new size rescales the file's own crop and re-frames an automatic camera.
/// Throws InputError when the crop does not lie within the image.
void apply(const Overrides& overrides, Scene& scene);

}  // namespace caplet::cli
