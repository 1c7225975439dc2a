// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// From a scene file to a picture, as the program does it, for tests.
#pragma once

#include <filesystem>
#include <functional>

#include "film/image.h"
#include "lower/flat_scene.h"
#include "render/render.h"
#include "scene/scene.h"
#include "support/compare.h"
#include "support/test_device.h"

namespace caplet::test {

struct Rendered {
  LayeredImage image;
  RenderResult result;
};

/// `change` may edit the scene before it is lowered. The picture has the layers of `options`: all,
/// unless asked.
Rendered render_file(const std::filesystem::path& file, int samples_per_pixel,
                     const std::function<void(Scene&)>& change = {}, RenderOptions options = {});
Rendered render_model(const Scene& scene, int samples_per_pixel, RenderOptions options = {});

/// A scene as devices take it, and as it is.
struct LoweredScene {
  Scene scene;
  FlatScene flat;
  FlatView view;
};
/// Glass, metal, a sky, a blurred lens and a light, in a picture of this size.
LoweredScene lowered_everything(int width, int height);

/// Adds 60,000 small capsules: a tree that rays are sorted for.
void add_cloud(Scene& scene);

/// The scene of a pbrt text.
Scene scene_of_text(const std::string& text);

/// Mean of a channel over the picture, and its standard error by the variance layer.
struct Mean {
  double value = 0, error = 0;
};
Mean mean_of(const LayeredImage& image, const std::string& name);

/// R G B (and variance, where present) of an image.
Picture picture_of(const LayeredImage& image);
const Channel& channel(const LayeredImage& image, const std::string& name);

}  // namespace caplet::test
