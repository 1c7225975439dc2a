// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/render_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>

#include "cli/overlays.h"
#include "cli/presets.h"
#include "film/sample_plan.h"
#include "report/stereo.h"

namespace caplet::cli {

namespace {

void add_outputs(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Output");
  command
      .add_option("-o,--output", o.outputs,
                  "What to write, as often as there is to: a picture .exr, tone-mapped ones "
                  ".png, .jpg and the like, of frames numbered ones (out.####.exr) or a movie "
                  ".mp4, .mov, .mkv, .webm, .gif; none: "
                  "no picture")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("OUT.exr|OUT.png|OUT.mp4|none")
      ->default_str("the scene's own name, .exr, here");
}

void add_frames(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Frames");
  command
      .add_option("--turntable", o.turntable,
                  "Frames of a camera that goes once around the scene, with studio light where the "
                  "file brings none")
      ->check(CLI::Range(1, 100000))
      ->type_name("N");
  command
      .add_option(
          "--frames", o.frames,
          "Which frames: of a turntable, of poses, of the models in a file of molecules, of "
          "numbered scene files (in.####.swc)")
      ->type_name("A-B|all");
  command
      .add_option("--poses", o.poses,
                  "A frame for each line of this file, a JSON object that says where shapes, "
                  "capsules, instances and the camera are; lines with a time are keys of an "
                  "animation")
      ->type_name("FILE.jsonl");
  command
      .add_option("--play", o.play,
                  "Frames of a scene that moves, from one time to another, in seconds")
      ->type_name("A:B");
  command.add_option("--fps", o.frames_a_second, "Frames a second of movies, animations")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str()
      ->type_name("R");
  command
      .add_option("--shutter", o.shutter,
                  "Motion blur: the part of a frame's time for which the shutter is open")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->type_name("SHARE");
  command.add_flag("--skip-existing", o.skip_existing, "Leave out frames whose files are there");
}

void add_preview_file(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Output");
  command
      .add_option("--preview", o.preview,
                  "Also write a tone-mapped 8-bit picture (.png, .jpg, .tif...)")
      ->type_name("FILE");
}

void add_size(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Size and quality");
  command
      .add_option("--spp", o.samples_per_pixel,
                  "Samples per pixel; with --noise the most that a pixel gets, else " +
                      std::to_string(NoiseTarget{}.most) +
                      "; unless asked the scene's, or its noise")
      ->check(CLI::Range(1, 1 << 24))
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--noise", [&o](const std::string& text) { o.noise = parse_noise(text); },
          "Render to this noise: pixels get as many samples as they need for it; of files that "
          "say nothing of it " +
              usual_noise_text())
      ->type_name("PERCENT%");
  command
      .add_option_function<std::string>(
          "--noise-space",
          [&o](const std::string& name) {
            o.noise_space = static_cast<NoiseSpace>(std::ranges::find(noise_space_names, name) -
                                                    noise_space_names.begin());
          },
          "What --noise is a share of: the luminance around a pixel, or the range of a display")
      ->check(CLI::IsMember(
          std::vector<std::string>(noise_space_names.begin(), noise_space_names.end())))
      ->type_name("relative|display")
      ->default_str("relative");
  command
      .add_option("--min-spp", o.least_samples,
                  "With --noise and --time: the fewest samples of a pixel")
      ->check(CLI::Range(2, 1 << 24))
      ->default_str(std::to_string(NoiseTarget{}.least))
      ->type_name("N");
  command
      .add_option("--size", o.size,
                  "Picture size in pixels; an automatic camera frames anew; unless asked the "
                  "scene's, else " +
                      usual_size())
      ->type_name("WxH");
  command
      .add_option("--crop", o.crop, "Render only these pixels (from the top left; x1, y1 excluded)")
      ->type_name("x0,y0,x1,y1");
}

void add_device_choice(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Devices");
  add_devices_option(command, o.device);
  add_encoding(command, o.encoding);
  command
      .add_option("--patience", o.patience,
                  "Leave a device out that does not answer for so long, where there are others")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str()
      ->type_name("SECONDS");
}

void add_quality(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Size and quality");
  command.add_option("--seed", o.seed, "Seed of the samples")
      ->type_name("S")
      ->default_str("the scene's");
  command.add_option("--max-depth", o.max_depth, "Most scattering events of a path")
      ->check(CLI::Range(0, 1 << 16))
      ->type_name("N")
      ->default_str("the scene's");
  command
      .add_option("--clamp", o.clamp,
                  "Greatest component of a sample, exposed, as pbrt's maxcomponentvalue: fewer "
                  "fireflies, a darker picture; 0: none")
      ->check(CLI::Range(0.0, 1e30))
      ->type_name("X")
      ->default_str("the scene's");
  command
      .add_option_function<std::string>(
          "--time", [&o](const std::string& text) { o.time_limit = parse_seconds("--time", text); },
          "Stop after the sample pass that passes this limit: seconds, or 5m, or 1h30m")
      ->type_name("TIME");
}

void add_layer_choice(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Output");
  command
      .add_option("--layers", o.layers,
                  "Layers beside R G B A: some of " + layer_names() + ", or all, or none")
      ->type_name("all|none|LAYER,...")
      ->default_str("all but the variance, the mattes and deep");
  add_matte_flags(command, o.mattes);
  add_depth_flags(command, o.depth);
}

void add_two_eyes(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Two eyes");
  command
      .add_option("--stereo", o.separation,
                  "Render for two eyes, so far apart, into one multi-view EXR")
      ->check(CLI::Range(1e-18, 1e18))
      ->type_name("SEPARATION");
  command
      .add_option("--convergence", o.convergence,
                  "Distance at which both eyes see things at one place")
      ->check(CLI::Range(1e-18, 1e18))
      ->type_name("DISTANCE")
      ->default_str("infinitely far");
  command
      .add_option("--stereo-layout", o.layout,
                  "How the preview shows both views: side by side (sbs), one over the other, or in "
                  "red and cyan")
      ->check(CLI::IsMember(std::vector<std::string>(report::stereo_layout_names.begin(),
                                                     report::stereo_layout_names.end())))
      ->type_name(fmt::format("{}", fmt::join(report::stereo_layout_names, "|")))
      ->default_str(report::stereo_layout_names.front());
}

void add_reports(CLI::App& command, RenderFlags& o) {
  command.option_defaults()->group("Output");
  command
      .add_option("--display", o.display,
                  "Show the picture in tev as it grows, such as 127.0.0.1:14158")
      ->type_name("HOST:PORT");
  command.add_flag("--variance", o.variance,
                   "Also write variance.R/G/B: the variance of each pixel's mean");
  command.add_flag("--denoise", o.denoise,
                   "Remove the noise by Open Image Denoise; noisy.R/G/B keep the picture before");
  command
      .add_option("--stats", o.stats, "Write times, ray counts and memory as JSON; -: to stdout")
      ->type_name("FILE.json");
  command
      .add_flag_callback(
          "--json", [&o] { o.stats = "-"; }, "Print what --stats writes")
      ->excludes("--stats");
  command.add_flag("-q,--quiet", o.quiet, "No progress, only warnings and errors");
  command.add_option("--batch", o.batch_paths, "Paths a batch (the picture does not depend on it)")
      ->group("");
}

}  // namespace

void add_render_flags(CLI::App& command, RenderFlags& o) {
  add_outputs(command, o);
  add_frames(command, o);
  add_preview_file(command, o);
  add_size(command, o);
  add_device_choice(command, o);
  add_quality(command, o);
  add_layer_choice(command, o);
  add_film_flags(command, o.film);
  add_two_eyes(command, o);
  add_reports(command, o);
  add_import_options(command, o.import_options);
  add_preset(command, o.preset);
  add_overlays(command, o.overlays);
}

}  // namespace caplet::cli
