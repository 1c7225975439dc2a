// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders the reference scenes at full quality, writes the table of docs/validation.md and difference images.
// validate SAMPLES OUT.md IMAGE_FOLDER
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "reference_scenes.h"
#include "render_scene.h"
#include "support/data.h"

namespace {

using namespace caplet;
using namespace caplet::test;

/// Ours, theirs and four times the difference around middle grey, side by side.
void write_difference(const std::filesystem::path& path, const Picture& ours, const Picture& theirs) {
  LayeredImage out;
  out.width = out.data_width = 3 * ours.width;
  out.height = out.data_height = ours.height;
  for (std::size_t c = 0; c < 3; ++c) {
    Channel channel{std::string(1, "RGB"[c]), {}, {}};
    for (int y = 0; y < ours.height; ++y)
      for (int x = 0; x < 3 * ours.width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y * ours.width + x % ours.width) * 3 + c;
        const float a = ours.rgb[at], b = theirs.rgb[at];
        channel.floats.push_back(x < ours.width ? a : x < 2 * ours.width ? b : 0.2f + 4 * (a - b) / (b + 0.05f) * 0.2f);
      }
    out.channels.push_back(channel);
  }
  write_preview(path, out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::cerr << "usage: validate SAMPLES OUT.md IMAGE_FOLDER\n", 2;
  const int samples = std::atoi(argv[1]);
  const std::filesystem::path images = argv[3];
  std::filesystem::create_directories(images);
  if (data_folder().empty()) return std::cerr << "validate: needs the shared data folder\n", 2;
  const auto folder = data_folder() / "reference" / "mitsuba";
  std::string table =
      "| scene | image mean | blocks rms | z mean | z sd | beyond 3 | seconds | within "
      "|\n|---|---:|---:|---:|---:|---:|---:|---|\n";
  bool all = true;
  for (const ReferenceScene& scene : reference_scenes()) {
    const Rendered ours = render_file(folder / (scene.name + ".pbrt"), samples);
    const Picture a = picture_of(ours.image), b = picture_of(read_exr(folder / (scene.name + ".exr")));
    const Figures f = compare(a, b);
    bool within = std::abs(f.mean) < scene.mean && f.blocks < scene.blocks;
    if (!scene.spectral) within = within && std::abs(f.z_mean) < allowed_z_mean && f.beyond_3 < allowed_beyond_3;
    all = all && within;
    table += scene.spectral ? fmt::format("| {} (spectral) | {:+.2f} % | {:.2f} % | | | | {:.0f} | {} |\n", scene.name,
                                          100 * f.mean, 100 * f.blocks, ours.result.render_seconds, within ? "yes" : "NO")
                            : fmt::format("| {} | {:+.2f} % | {:.2f} % | {:+.2f} | {:.2f} | {:.2f} % | {:.0f} | {} |\n",
                                          scene.name, 100 * f.mean, 100 * f.blocks, f.z_mean, f.z_sd, 100 * f.beyond_3,
                                          ours.result.render_seconds, within ? "yes" : "NO");
    write_exr(images / (scene.name + ".exr"), ours.image);
    write_difference(images / (scene.name + ".png"), a, b);
    std::cerr << scene.name << (within ? " agrees\n" : " DISAGREES\n");
  }
  std::ofstream(argv[2]) << table;
  std::cout << table;
  return all ? 0 : 1;
}
