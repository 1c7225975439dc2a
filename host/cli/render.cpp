// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet render`: scene file in, pictures out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>

#include "base/atomic_file.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/summary.h"
#include "cli/trial.h"
#include "film/develop.h"
#include "film/image.h"
#include "import/import.h"
#include "lower/lower.h"
#include "render/render.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

struct Options {
  Encoding encoding = Encoding::automatic;
  std::string scene, output, preview, stats, device, size, crop;
  std::optional<int> samples_per_pixel, max_depth;
  std::optional<std::uint32_t> seed;
  std::optional<double> time_limit;
  std::size_t batch_paths = 0;
  bool variance = false, quiet = false;
};

class Stopwatch {
 public:
  /// Seconds since the construction or the last lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void check_exr(const fs::path& path) {
  if (path.extension() != ".exr")
    throw InputError(SourceLocation{"-o"},
                     fmt::format("'{}': pictures are written as .exr (use --preview for other formats)", path.string()));
}

/// What can be known to be wrong before anything is loaded.
Overrides check_options(const Options& options) {
  Overrides overrides;
  if (!options.size.empty()) overrides.size = parse_size(options.size);
  if (!options.crop.empty()) overrides.crop = parse_crop(options.crop);
  overrides.samples_per_pixel = options.samples_per_pixel;
  overrides.max_depth = options.max_depth;
  overrides.seed = options.seed;
  if (!options.output.empty()) {
    check_exr(options.output);
    check_writable(options.output, "-o");
  }
  if (!options.preview.empty()) {
    check_preview_format(options.preview, "--preview");
    check_writable(options.preview, "--preview");
  }
  if (!options.stats.empty()) check_writable(options.stats, "--stats");
  return overrides;
}

/// Where the picture goes: as asked, or by the scene's own film name (else the scene file's) in the current folder.
fs::path output_path(const Options& options, const Scene& scene) {
  if (!options.output.empty()) return options.output;
  fs::path name = fs::path(scene.film.filename).filename();
  if (name.empty()) name = fs::path(options.scene).filename();
  name.replace_extension(".exr");
  check_writable(name, "-o");
  return name;
}

constexpr const char* interrupted_early = "interrupted before anything was rendered; nothing is written";

RenderResult render_with_progress(const FlatScene& flat, const Device& device, const RenderOptions& render_options, bool quiet) {
  ProgressReporter reporter(ProgressReporter::style_for_stderr(quiet));
  try {
    return render(flat, device, render_options, [&](const Progress& progress) {
      reporter.update(progress.fraction, progress.samples_per_second,
                      fmt::format("{:.0f}/{} samples", std::floor(progress.fraction * render_options.samples_per_pixel + 1e-6),
                                  render_options.samples_per_pixel));
    });
  } catch (const RunError&) {
    // A driver's compiler gives up on the signal: that is no fault of its own.
    if (interrupt_requested()) throw RunError(interrupted_early);
    throw;
  }
}

void add_metadata(LayeredImage& image, const Scene& scene, const Options& options, const Invocation& invocation,
                  const Device& device, const RenderResult& result) {
  image.metadata["software"] = "Caplet " CAPLET_VERSION;
  image.metadata["caplet.version"] = CAPLET_VERSION;
  image.metadata["caplet.scene"] = options.scene;
  image.metadata["caplet.command"] = invocation.command_line();
  image.metadata["caplet.samples_per_pixel"] = fmt::format("{}", result.samples_per_pixel);
  image.metadata["caplet.seed"] = fmt::format("{}", scene.sampler.seed);
  image.metadata["caplet.max_depth"] = fmt::format("{}", scene.integrator.max_depth);
  image.metadata["caplet.device"] = device.info().name;
  image.metadata["caplet.driver"] = device.info().driver;
  image.metadata["caplet.platform"] = device.info().platform;
  image.metadata["caplet.render_seconds"] = fmt::format("{:.3f}", result.render_seconds);
  image.metadata["caplet.interrupted"] = result.interrupted ? "yes" : "no";
}

void write_text(const fs::path& path, const std::string& text) {
  write_atomically(path, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw RunError(fmt::format("{}: cannot be written", path.string()));
  });
}

void run_render(const Options& options, const Invocation& invocation) {
  Stopwatch total, phase;
  RunSeconds seconds;
  log::set_quiet(options.quiet);
  const Overrides overrides = check_options(options);
  install_interrupt_handlers();
  const Device device = Device::choose(options.device, options.encoding);

  phase.lap();
  Scene scene = import_scene(options.scene, FileImageReader());
  apply(overrides, scene);
  const fs::path output = output_path(options, scene);
  seconds.load = phase.lap();
  const FlatScene flat = lower(scene);
  seconds.build = phase.lap();
  if (interrupt_requested()) throw RunError(interrupted_early);

  try_device_apart(device, {.basic_shapes = flat.basic_shapes(), .render = true});
  if (!options.quiet)
    log::info("{}: {} primitives, {} x {} pixels, {} samples per pixel on {}", options.scene, flat.primitive_count,
              flat.params.crop_width, flat.params.crop_height, scene.sampler.samples_per_pixel, device.info().name);
  RenderOptions render_options;
  render_options.samples_per_pixel = scene.sampler.samples_per_pixel;
  render_options.time_limit = options.time_limit;
  render_options.batch_paths = options.batch_paths;
  render_options.time_stages = !options.stats.empty();
  const RenderResult result = render_with_progress(flat, device, render_options, options.quiet);
  seconds.compile = result.compile_seconds;
  seconds.render = result.render_seconds;

  LayeredImage image = develop(result.film, flat.params, scene, options.variance);
  add_metadata(image, scene, options, invocation, device, result);
  write_exr(output, image);
  if (!options.preview.empty()) write_preview(options.preview, image);
  seconds.total = total.lap();
  if (!options.stats.empty()) write_text(options.stats, to_text(run_summary(seconds, result, device)));
  if (result.interrupted)
    log::warn("interrupted: {} holds {} of {} samples per pixel", output.string(), result.samples_per_pixel,
              scene.sampler.samples_per_pixel);
  log::info("wrote {}", output.string());
}

}  // namespace

void add_render(CLI::App& app, const Invocation& invocation) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "Render a scene file to an OpenEXR picture");
  command->add_option("SCENE", o->scene, "Scene file: .pbrt (pbrt-v4), .capsules or .swc")->required();
  command->add_option("-o,--output", o->output, "Picture to write, .exr (default: the scene's own name, here)")
      ->type_name("OUT.exr");
  command->add_option("--preview", o->preview, "Also write a tone-mapped 8-bit picture (.png, .jpg, .tif...)")->type_name("FILE");
  command->add_option("--spp", o->samples_per_pixel, "Samples per pixel")->check(CLI::Range(1, 1 << 24))->type_name("N");
  command->add_option("--size", o->size, "Picture size in pixels; an automatic camera frames anew")->type_name("WxH");
  command->add_option("--crop", o->crop, "Render only these pixels (from the top left; x1, y1 excluded)")
      ->type_name("x0,y0,x1,y1");
  command->add_option("--device", o->device, "OpenCL device: index, cpu, gpu or part of its name (see `caplet devices`)")
      ->type_name("D");
  add_encoding(*command, o->encoding);
  command->add_option("--seed", o->seed, "Seed of the samples")->type_name("S");
  command->add_option("--max-depth", o->max_depth, "Most scattering events of a path")
      ->check(CLI::Range(0, 1 << 16))
      ->type_name("N");
  command->add_option("--time", o->time_limit, "Stop after the sample pass that passes this limit")
      ->check([](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return std::isfinite(value) && value > 0 ? std::string() : "'" + text + "' is not a positive number of seconds";
      })
      ->type_name("SECONDS");
  command->add_flag("--variance", o->variance, "Also write variance.R/G/B: the variance of each pixel's mean");
  command->add_option("--stats", o->stats, "Write times, ray counts and memory as JSON")->type_name("FILE.json");
  command->add_flag("-q,--quiet", o->quiet, "No progress, only warnings and errors");
  command->add_option("--batch", o->batch_paths, "Paths a batch (the picture does not depend on it)")->group("");
  command->footer(
      "Options override the scene file. Ctrl-C finishes the sample pass and writes what there is; a second one stops at once.\n"
      "The picture is scene-linear, with layers albedo, N, P, Z, object.id and primitive.id.");
  command->callback([o, &invocation] { run_render(*o, invocation); });
}

}  // namespace caplet::cli
