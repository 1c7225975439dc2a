// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Options that several values make up, and what they change in a scene.
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

/// The path of an output: "-" is the standard output.
std::filesystem::path output_named(const std::string& text);

/// "960x540": two whole numbers from 1, at most 2^28 pixels in all. Throws InputError naming --size.
ImageSize parse_size(const std::string& text);

/// "x0,y0,x1,y1" in pixels from the top left, x1 and y1 excluded. Throws InputError naming --crop.
std::array<int, 4> parse_crop(const std::string& text);

/// "X,Y": a pixel of the full image, from the top left. Throws InputError naming --pixel.
std::array<int, 2> parse_pixel(const std::string& text);

/// "ox,oy,oz,dx,dy,dz": origin and direction (of any length). Throws InputError naming --ray.
RayNumbers parse_ray(const std::string& text);

/// The layers to write: what every picture has where there is no `list`; "all", "none", or some of layer_rows' options between
/// commas. And the variance, when asked for. Throws InputError naming --layers.
Layers parse_layers(const std::optional<std::string>& list, bool variance);

/// Adds an option --NAME for each of import_option_rows, which goes into `options` where it is given. SCENE is the option before.
void add_import_options(CLI::App& command, ImportOptions& options);

/// The extensions of all scene formats, for help: ".pbrt, .swc, ...".
std::string scene_extensions();

/// What pictures have where neither the scene nor the user says it, for help: samples a pixel of all formats ("16, 64 of swc"),
/// least widths of capsules, and the size.
std::string usual_samples();
std::string usual_least_width();
std::string usual_size();

/// Adds the argument SCENE: a file, or several that make one scene.
CLI::Option* add_scene_files(CLI::App& command, std::vector<std::string>& scenes);
/// import_scenes (import/import.h).
Scene import_files(const std::vector<std::string>& scenes, const ImportOptions& options);
/// Their names, for messages and metadata: with a blank between.
std::string scene_names(const std::vector<std::string>& scenes);

/// What `work` does; what it throws as InputError names `flag`.
template <class Work>
auto with_flag(const char* flag, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(SourceLocation{flag}, error.what());
  }
}

/// What `choose` returns: a device, or its number. What it throws about the choice names --device.
template <class Choose>
auto with_device_flag(const Choose& choose) {
  try {
    return choose();
  } catch (const UnknownDevice& error) {
    throw InputError(SourceLocation{"--device"}, error.what());
  } catch (const NoDevice& error) {
    throw RunError(std::string("--device: ") + error.what() + "; `caplet doctor` tells what is missing");
  }
}

/// Device::choose and choose_several.
Device choose_device(const std::string& choice, Encoding encoding);
std::vector<Device> choose_devices(const std::string& choice, Encoding encoding);

/// Adds `--device`, which chooses one, or several of them.
void add_device(CLI::App& command, std::string& choice);
void add_devices_option(CLI::App& command, std::string& choice);

/// The names of all layers, for help: "Z, albedo, ...".
std::string layer_names();

/// Adds `--encoding`, which forces the way kernels go through the tree.
void add_encoding(CLI::App& command, Encoding& encoding);

/// What the command line overrides.
struct Overrides {
  std::optional<ImageSize> size;
  std::optional<std::array<int, 4>> crop;  // x0, y0, x1, y1
  std::optional<int> samples_per_pixel, max_depth;
  std::optional<std::uint32_t> seed;
  std::optional<double> clamp;  // film.max_component_value; 0: none
};

/// Applies them; a new size rescales the file's own crop and re-frames an automatic camera. Throws InputError when the crop does
/// not lie within the image.
void apply(const Overrides& overrides, Scene& scene);

}  // namespace caplet::cli
