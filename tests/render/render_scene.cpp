// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render_scene.h"

#include <cmath>
#include <fstream>
#include <random>
#include <stdexcept>

#include "film/develop.h"
#include "import/import.h"
#include "lower/lower.h"
#include "support/data.h"

namespace caplet::test {

Rendered render_model(const Scene& scene, int samples_per_pixel, RenderOptions options) {
  const FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  options.samples_per_pixel = samples_per_pixel;
  Rendered out;
  out.result = render(flat, view, test_device(), options, {});
  out.image = develop(out.result.film, scene.view.film, options.layers);
  return out;
}

Rendered render_file(const std::filesystem::path& file, int samples_per_pixel,
                     const std::function<void(Scene&)>& change, RenderOptions options) {
  Scene scene = import_scene(file, FileImageReader());
  if (change) change(scene);
  return render_model(scene, samples_per_pixel, options);
}

LoweredScene lowered_everything(int width, int height) {
  LoweredScene out;
  out.scene =
      import_scene(source_folder() / "tests" / "render" / "everything.pbrt", FileImageReader());
  out.scene.view.film.width = width;
  out.scene.view.film.height = height;
  out.flat = lower(out.scene);
  out.view = lower_view(out.scene);
  return out;
}

void add_cloud(Scene& scene) {
  CapsulesShape many;
  std::mt19937 random(1);
  const auto draw = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f * 2 - 1; };
  for (int i = 0; i < 60000; ++i) {
    const glm::vec3 middle{3 * draw(), 3 * draw(), 3 * draw()},
        half{0.05f * draw(), 0.05f * draw(), 0.05f * draw()};
    many.p0.push_back(middle - half);
    many.p1.push_back(middle + half);
    many.radius0.push_back(0.02f);
  }
  Shape cloud;
  cloud.geometry = many;
  scene.shapes.push_back(cloud);
}

const Channel& channel(const LayeredImage& image, const std::string& name) {
  for (const Channel& channel : image.channels)
    if (channel.name == name) return channel;
  throw std::logic_error("no channel " + name);
}

Scene scene_of_text(const std::string& text) {
  const auto file = temporary_folder() / "text.pbrt";
  std::ofstream(file) << text;
  return import_scene(file, FileImageReader());
}

Mean mean_of(const LayeredImage& image, const std::string& name) {
  const std::vector<float>&values = channel(image, name).floats,
        &variances = channel(image, "variance." + name).floats;
  const auto pixels = static_cast<double>(values.size());
  Mean out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.value += values[i] / pixels;
    out.error += variances[i] / (pixels * pixels);
  }
  out.error = std::sqrt(out.error);
  return out;
}

Picture picture_of(const LayeredImage& image) {
  Picture out;
  out.width = image.data_width;
  out.height = image.data_height;
  const std::size_t pixels =
      static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  const auto interleave = [&](const std::string& prefix) {
    std::vector<float> values(3 * pixels);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string name = prefix + "RGB"[c];
      const Channel& from = channel(image, name);
      for (std::size_t i = 0; i < pixels; ++i) values[3 * i + c] = from.floats[i];
    }
    return values;
  };
  out.rgb = interleave("");
  for (const Channel& c : image.channels)
    if (c.name == "variance.R") out.variance = interleave("variance.");
  return out;
}

}  // namespace caplet::test
