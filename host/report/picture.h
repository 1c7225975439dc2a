// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A render's picture as files: what is noted in it, and the picture with its preview.
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

/// Attributes of a picture (docs/output.md). `scene_file` and `command`: how the scene was named, and what made the picture (a
/// command line, a program's name).
std::map<std::string, std::string> picture_metadata(const Scene& scene, const std::string& scene_file, const std::string& command,
                                                    const RenderResult& result);

/// Returns a property of the devices that have made the picture, with commas.
std::string of_devices(const RenderResult& result, std::string DeviceWork::*what);

/// What is done to a whole preview before it is written.
struct Finish {
  Layers layers = Layers::none();  // that it looks at
  Layers written = Layers::all();  // channels of others are not written
  std::function<void(Shown& picture, const LayeredImage& layers)> draw;
};

/// The picture and its preview, developed once, band by band. An empty path: not written. `channels`: of 32 bits;
/// `render_seconds` weighs how long packing may take. Throws RunError.
void write_pictures(const std::filesystem::path& picture, const std::filesystem::path& preview, const BandedImage& image,
                    std::size_t channels, double render_seconds, const Finish& finish = {});

}  // namespace caplet::report
