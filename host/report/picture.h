// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes a render's picture and preview as files, with their metadata.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "film/image.h"
#include "film/layers.h"
#include "film/preview.h"
#include "render/render.h"
#include "scene/scene.h"

namespace caplet::report {

/// Returns the attributes of a picture (docs/output.md). `scene_file` and `command`: the name of
/// the scene, and what made the picture (a command line or a program's name).
std::map<std::string, std::string> picture_metadata(const Scene& scene,
                                                    const std::string& scene_file,
                                                    const std::string& command,
                                                    const RenderResult& result);

/// Returns a property of the devices that rendered the picture, separated by commas.
std::string of_devices(const RenderResult& result, std::string DeviceWork::*what);

/// The last step of a preview before it is written.
struct Finish {
  Layers layers = Layers::none();  // those that it needs
  Layers written = Layers::all();  // channels of other layers are not written
  std::function<void(Shown& picture, const LayeredImage& layers)> draw;
};

/// Writes the picture and its preview, developed once, in bands. An empty path is not written.
/// `channels`: the number of 32-bit channels; `render_seconds` limits the time of compression.
/// Throws RunError.
void write_pictures(const std::filesystem::path& picture, const std::filesystem::path& preview,
                    const BandedImage& image, std::size_t channels, double render_seconds,
                    const Finish& finish = {});

}  // namespace caplet::report
