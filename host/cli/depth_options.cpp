// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/depth_options.h"

#include <CLI/CLI.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/options.h"
#include "present/depth_plane.h"

namespace caplet::cli {

void add_depth_flags(CLI::App& command, DepthFlags& flags) {
  command.option_defaults()->group("Output");
  command
      .add_option("--depth", flags.file,
                  "Also write depths: as EXR (Z in scene units, NaN where nothing is) or as PNG of "
                  "16 bits (0 where nothing is)")
      ->type_name("FILE");
  command
      .add_option("--depth-kind", flags.kind,
                  "With --depth: distances from the camera, or along its axis, as ROS and MuJoCo "
                  "have them")
      ->check(CLI::IsMember({"range", "planar"}))
      ->type_name("range|planar")
      ->default_str("range");
  command
      .add_option("--depth-unit", flags.unit,
                  "With --depth: a PNG's steps in scene units; millimetres of metres unless asked")
      ->check(CLI::Range(1e-18, 1e18))
      ->type_name("U")
      ->default_str("0.001");
}

std::filesystem::path depth_path(const DepthFlags& flags) {
  if (flags.file.empty()) {
    if (flags.kind || flags.unit)
      throw InputError(SourceLocation{flags.kind ? "--depth-kind" : "--depth-unit"},
                       "goes with --depth");
    return {};
  }
  std::filesystem::path path = output_named(flags.file);
  if (!is_stream(path) && path.extension() != ".exr" && path.extension() != ".png")
    throw InputError(SourceLocation{"--depth"},
                     "'" + flags.file + "': depth pictures are written as .exr or .png");
  if (flags.unit && path.extension() != ".png")
    throw InputError(SourceLocation{"--depth-unit"}, "goes with --depth FILE.png");
  return path;
}

void check_depth(const DepthFlags& flags, const Camera& camera, bool is_turned) {
  if (!flags.file.empty() && flags.is_planar() && (is_turned || !camera.motion.empty()))
    throw InputError(SourceLocation{"--depth-kind"},
                     "planar depths need a camera that rests while the shutter is open");
}

DepthPicture depth_picture(const DepthFlags& flags, const std::filesystem::path& path,
                           const Camera& camera) {
  DepthPicture out;
  out.path = path;
  if (flags.is_planar()) out.plane = depth_plane_of(camera);
  if (flags.unit) out.unit = *flags.unit;
  return out;
}

}  // namespace caplet::cli
