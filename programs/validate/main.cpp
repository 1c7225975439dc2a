// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders the reference scenes at full quality, writes the table of docs/validation.md and
// difference images. caplet_validate SAMPLES OUT.md IMAGE_FOLDER
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>

#include "reference_scenes.h"
#include "render_scene.h"
#include "support/data.h"

namespace {

using namespace caplet;
using namespace caplet::test;

/// Ours, theirs and four times the difference around middle grey, side by side.
void write_difference(const std::filesystem::path& path, const Picture& ours,
                      const Picture& theirs) {
  LayeredImage out;
  out.width = out.data_width = 3 * ours.width;
  out.height = out.data_height = ours.height;
  for (std::size_t c = 0; c < 3; ++c) {
    Channel channel{std::string(1, "RGB"[c]), {}, {}};
    for (int y = 0; y < ours.height; ++y)
      for (int x = 0; x < 3 * ours.width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y * ours.width + x % ours.width) * 3 + c;
        const float a = ours.rgb[at], b = theirs.rgb[at];
        channel.floats.push_back(x < ours.width       ? a
                                 : x < 2 * ours.width ? b
                                                      : 0.2f + 4 * (a - b) / (b + 0.05f) * 0.2f);
      }
    out.channels.push_back(channel);
  }
  write_preview(path, out);
}

/// Image mean of the Cornell box of the scene collection against Tungsten's picture of it, which
/// was rendered in RGB.
std::string cornell_box_row(int samples, bool& within) {
  const auto folder = data_folder() / "scenes_pbrt" / "cornell-box";
  const Rendered ours = render_file(folder / "scene-v4.pbrt", samples, [](Scene& scene) {
    scene.view.integrator.max_depth = 65;
    scene.view.film.width = scene.view.film.height = 256;
  });
  const auto mean = [](const Picture& picture) {
    double sum = 0;
    for (const float value : picture.rgb) sum += static_cast<double>(value);
    return sum / static_cast<double>(picture.rgb.size());
  };
  const double difference =
      mean(picture_of(ours.image)) / mean(picture_of(read_exr(folder / "TungstenRender.exr"))) - 1;
  within = std::abs(difference) < 0.015;
  return fmt::format(
      "\nThe rows of environment images stand where Mitsuba "
      "puts them ([lights](lights.md#image-light)).\n\nThe image mean of `scenes_pbrt/cornell-box` "
      "at depth 65, 256 x 256 "
      "pixels, {} samples differs by\n{:+.2f} % from "
      "`TungstenRender.exr` (an RGB render; within 1.5 %: {}).\n",
      samples, 100 * difference, within ? "yes" : "NO");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::cerr << "usage: caplet_validate SAMPLES OUT.md IMAGE_FOLDER\n", 2;
  const int samples = std::atoi(argv[1]);
  const std::filesystem::path document = argv[2], images = argv[3];
  if (samples < 1) return std::cerr << "caplet_validate: SAMPLES must be a positive number\n", 2;
  if (data_folder().empty())
    return std::cerr << "caplet_validate: needs the shared data folder\n", 2;
  std::filesystem::create_directories(images);
  const auto folder = data_folder() / "reference" / "mitsuba";
  // The page's lines as they stand in it.
  std::string text = fmt::format(
      R"(# Validation

This page compares Caplet's pictures with those of Mitsuba 3, Tungsten and pbrt-v4, and says why
they differ where they do. These commands compare again (DATA is the shared data):

```
./run validate [SAMPLES]                           the next table and pictures (default 1024 samples a pixel)
PYTHON tools/appearance.py --spp 128 materials     materials beside Mitsuba 3
PYTHON tools/appearance.py --spp 64 scenes DATA    real scenes
PYTHON tools/pbrt_reference.py DATA                scenes beside pbrt-v4
```

`./run validate` renders six scenes in pbrt-v4 text at 128 x 128 pixels and compares them with
pictures of Mitsuba 3.9.1, which are means of 16,384 samples a pixel with their variances. It ran
last with {} samples a pixel or more on {} ({}). A scene is "within" when all of these hold:

| | grey (spectra play no part) | spectral |
|---|---|---|
| the image means differ by less than | 0.3 % | 0.5 % |
| means of blocks of 8 x 8 pixels differ by less than (rms) | 1 %; mis-grey 2 % | 1 % |
| z = (ours - theirs) / sqrt(sum of variances), of each pixel | mean within 0.3, less than 3 % beyond 3 | |

| scene | samples | image mean | blocks rms | z mean | z sd | beyond 3 | seconds | within |
|---|---:|---:|---:|---:|---:|---:|---:|---|
)",
      samples, test_device().info().name, test_device().info().driver);
  std::string pictures =
      "\nEach picture shows Caplet's, Mitsuba's, and their difference around grey. A fifth of full "
      "scale is a\nrelative "
      "difference of a quarter.\n";
  bool all = true;
  for (const ReferenceScene& scene : reference_scenes()) {
    const int effort = samples * scene.effort;
    const Rendered ours =
        render_file(folder / (scene.name + ".pbrt"), effort, place_rows_as_mitsuba);
    const Picture a = picture_of(ours.image),
                  b = picture_of(read_exr(folder / (scene.name + ".exr")));
    const Figures f = compare(a, b);
    bool within = std::abs(f.mean) < scene.mean && f.blocks < scene.blocks;
    if (!scene.spectral)
      within = within && std::abs(f.z_mean) < allowed_z_mean && f.beyond_3 < allowed_beyond_3;
    all = all && within;
    const std::string z = scene.spectral ? " | | "
                                         : fmt::format("{:+.2f} | {:.2f} | {:.2f} %", f.z_mean,
                                                       f.z_sd, 100 * f.beyond_3);
    text += fmt::format("| {}{} | {} | {:+.2f} % | {:.2f} % | {} | {:.0f} | {} |\n", scene.name,
                        scene.spectral ? " (spectral)" : "", effort, 100 * f.mean, 100 * f.blocks,
                        z, ours.result.render_seconds, within ? "yes" : "NO");
    write_difference(images / (scene.name + ".png"), a, b);
    pictures += fmt::format("\n![{0}](images/validation/{0}.png)\n", scene.name);
    std::cerr << scene.name << (within ? " agrees\n" : " DISAGREES\n");
  }
  bool tungsten = false;
  text += cornell_box_row(std::max(16, samples / 4), tungsten);
  // What tools/appearance.py writes stays.
  std::ifstream before(document);
  const std::string page{std::istreambuf_iterator<char>(before), {}};
  before.close();
  const std::size_t sections = std::min(page.find("\n## "), page.size());
  std::ofstream out(document);
  out << text << pictures << page.substr(sections);
  std::cout << text;
  if (!out)
    return std::cerr << "caplet_validate: " << document.string() << " cannot be written\n", 1;
  return all && tungsten ? 0 : 1;
}
