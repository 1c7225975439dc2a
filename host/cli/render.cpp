// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet render`: scene file in, pictures out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/overlays.h"
#include "cli/trial.h"
#include "device/second_try.h"
#include "display/tev.h"
#include "film/develop.h"
#include "film/image.h"
#include "import/import.h"
#include "lower/lower.h"
#include "present/least_width.h"
#include "present/stereo.h"
#include "render/render.h"
#include "report/bands.h"
#include "report/picture.h"
#include "report/stereo.h"
#include "report/summary.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

struct Options {
  Encoding encoding = Encoding::automatic;
  std::string scene, output, preview, stats, device, size, crop;
  ImportOptions import_options;
  post::Overlays overlays;
  std::optional<std::string> layers;
  std::optional<int> samples_per_pixel, max_depth;
  std::optional<std::uint32_t> seed;
  std::optional<double> time_limit, clamp, separation, convergence;
  std::string layout, display;
  double patience = 60;
  std::size_t batch_paths = 0;
  bool variance = false, quiet = false;
};

constexpr const char* no_picture = "none";

/// The outputs and their paths; empty: not wanted.
struct Files {
  fs::path picture, preview, stats;
  Outputs all;
};

void add_picture(Files& files, const fs::path& path) {
  files.picture = path;
  files.all.add("-o", path);
  if (path.extension() != ".exr" && !is_stream(path))
    throw InputError(SourceLocation{"-o"},
                     fmt::format("'{}': pictures are written as .exr (use --preview for other formats)", path.string()));
}

/// Reports what is wrong with options and outputs before anything is loaded.
Overrides check_options(const Options& options, Files& files) {
  Overrides overrides;
  if (!options.size.empty()) overrides.size = parse_size(options.size);
  if (!options.crop.empty()) overrides.crop = parse_crop(options.crop);
  overrides.samples_per_pixel = options.samples_per_pixel;
  overrides.max_depth = options.max_depth;
  overrides.seed = options.seed;
  overrides.clamp = options.clamp;
  if (!options.separation && (options.convergence || !options.layout.empty()))
    throw InputError(SourceLocation{options.convergence ? "--convergence" : "--stereo-layout"}, "goes with --stereo");
  if (options.overlays.any() && (options.preview.empty() || options.separation))
    throw InputError(SourceLocation{"--preview"},
                     options.separation ? "overlays are not drawn for two eyes (--stereo)" : "overlays are drawn on it alone");
  if (options.output == no_picture && options.preview.empty() && options.stats.empty())
    throw InputError(SourceLocation{"-o"}, "'none' goes with --preview or --stats: nothing would be written");
  if (!options.output.empty() && options.output != no_picture) add_picture(files, output_named(options.output));
  if (!options.preview.empty()) {
    files.preview = options.preview;
    check_preview_format(files.preview, "--preview");
    files.all.add("--preview", files.preview);
  }
  if (!options.stats.empty()) {
    files.stats = output_named(options.stats);
    files.all.add("--stats", files.stats);
  }
  return overrides;
}

report::StereoLayout layout_of(const Options& options) {
  const auto found = std::ranges::find(report::stereo_layout_names, options.layout);
  return found == report::stereo_layout_names.end()
             ? report::StereoLayout::side_by_side
             : static_cast<report::StereoLayout>(found - report::stereo_layout_names.begin());
}

/// What the scene tells of outputs: the picture's name (the scene's own film name, else the scene file's, in the current folder),
/// its size, and the files that the scene was read from.
void check_outputs(const Options& options, const Scene& scene, Layers layers, Files& files) {
  if (options.output.empty()) {
    fs::path name = fs::path(scene.film.filename).filename();
    if (name.empty()) name = fs::path(options.scene).filename();
    add_picture(files, name.replace_extension(".exr"));
  }
  files.all.check_inputs();
  const std::array<int, 4> window = scene.film.crop.value_or(std::array<int, 4>{0, scene.film.width, 0, scene.film.height});
  const int width = window[1] - window[0], height = window[3] - window[2];
  const std::string flag = options.crop.empty() ? "--size" : "--crop";
  if (!files.picture.empty()) check_exr_size(width, height, layers.channels() * (options.separation ? 2 : 1), flag);
  const bool is_transparent = scene.film.backdrop && scene.film.backdrop->kind == Backdrop::Kind::transparent;
  if (!files.preview.empty() && is_transparent && !options.separation) check_preview_alpha(files.preview, "--preview");
  if (!files.preview.empty())
    check_preview_size(files.preview,
                       options.separation && layout_of(options) == report::StereoLayout::side_by_side ? 2 * width : width,
                       options.separation && layout_of(options) == report::StereoLayout::over_under ? 2 * height : height, flag);
}

constexpr const char* interrupted_early = "interrupted before anything was rendered; nothing is written";

void guard(const std::vector<Device>& devices) {
  for (const Device& device : devices) SecondTry::guard(device);
}

std::string names_of(const std::vector<Device>& devices) {
  std::string out;
  for (const Device& device : devices) out += (out.empty() ? "" : " and ") + device.info().name;
  return out;
}

RenderResult render_with_progress(const FlatScene& flat, const FlatView& view, const std::vector<Device>& devices,
                                  const RenderOptions& render_options, bool quiet) {
  ProgressReporter reporter(ProgressReporter::style_for_stderr(quiet));
  try {
    return render(flat, view, devices, render_options, [&](const Progress& progress) {
      if (progress.samples_done > 0 || progress.fraction >= 1)
        SecondTry::driver_works();
      else
        guard(devices);  // again: the kernels' compiler may have set signal handlers
      reporter.update(progress.fraction, progress.samples_per_second,
                      fmt::format("{:.0f}/{} samples", std::floor(progress.fraction * render_options.samples_per_pixel + 1e-6),
                                  render_options.samples_per_pixel));
    });
  } catch (const RunError&) {
    // A driver's compiler may fail because of the signal: then the interrupt is the reason, not the driver.
    if (interrupt_requested()) throw RunError(interrupted_early);
    throw;
  }
}

/// All that a picture is made of.
struct Work {
  const Options& options;
  const Invocation& invocation;
  const Scene& scene;
  const FlatScene& flat;
  const std::vector<Device>& devices;
  Layers layers, film_layers;  // that are written, and with those that overlays look at
  const Files& files;
  RenderOptions render_options;
};

/// Renders a view, which tev shows as it grows where it is asked to.
RenderResult render_shown(const Work& work, const FlatView& view, const std::string& view_name) {
  if (work.options.display.empty())
    return render_with_progress(work.flat, view, work.devices, work.render_options, work.options.quiet);
  constexpr double most_seconds_at_the_end = 5;
  const std::string name = (work.files.picture.empty() ? fs::path(work.options.scene) : work.files.picture).filename().string();
  TevDisplay display(parse_tev_address(work.options.display, "--display"),
                     view_name.empty() ? name : name + " (" + view_name + ")");
  NotFinite ignored;
  RenderOptions shown = work.render_options;
  shown.film_on_device = false;
  shown.look = [&](const Film& film) {
    if (display.is_idle()) display.show(develop(film, work.scene, work.layers, ignored));
  };
  RenderResult result = render_with_progress(work.flat, view, work.devices, shown, work.options.quiet);
  display.show(develop(result.film, work.scene, work.layers, ignored));
  display.finish(most_seconds_at_the_end);
  return result;
}

void add_to(report::RunSeconds& seconds, const RenderResult& result) {
  seconds.compile += result.compile_seconds;
  seconds.render += result.render_seconds;
}

BandedImage bands_of(const Work& work, const RenderResult& result, NotFinite& not_finite) {
  BandedImage out = result.device_film ? report::developed_in_bands(*result.device_film, work.scene, work.film_layers, not_finite)
                                       : report::developed_in_bands(result.film, work.scene, work.film_layers, not_finite);
  out.whole.metadata = report::picture_metadata(work.scene, work.options.scene, work.invocation.command_line(), result);
  return out;
}

RenderResult one_picture(const Work& work, const FlatView& view, report::RunSeconds& seconds) {
  RenderResult result = render_shown(work, view, "");
  add_to(seconds, result);
  NotFinite not_finite;
  const BandedImage picture = bands_of(work, result, not_finite);
  Stopwatch phase;
  const post::Overlays& overlays = work.options.overlays;
  report::Finish finish{overlays.layers(), work.layers, {}};
  if (overlays.any())
    finish.draw = [&](Shown& shown, const LayeredImage& layers) { post::draw(shown, layers, work.scene, overlays); };
  report::write_pictures(work.files.picture, work.files.preview, picture, work.layers.channels(), result.render_seconds, finish);
  not_finite.warn();
  seconds.write = phase.lap();
  return result;
}

/// The views of two eyes, one after the other. The right one gets as many samples as the left one got. What is returned tells of
/// both.
RenderResult stereo_pictures(const Work& both, report::RunSeconds& seconds) {
  const Stereo stereo{*both.options.separation, both.options.convergence};
  std::array<RenderResult, 2> results;
  for (const Eye eye : {Eye::left, Eye::right}) {
    Work work = both;
    work.render_options.film_on_device = false;
    if (work.render_options.time_limit) *work.render_options.time_limit /= 2;
    Scene seen;
    seen.camera = camera_of_eye(both.scene, stereo, eye);
    seen.filter = both.scene.filter;
    seen.film = both.scene.film;
    seen.sampler = both.scene.sampler;
    seen.integrator = both.scene.integrator;
    const std::size_t i = eye == Eye::left ? 0 : 1;
    if (i == 1) work.render_options.samples_per_pixel = results[0].samples_per_pixel;
    if (i == 1) work.render_options.time_limit.reset();
    results[i] = render_shown(work, lower_view(seen), eye == Eye::left ? "left" : "right");
    add_to(seconds, results[i]);
    if (results[i].interrupted && i == 0) throw RunError("interrupted before there was a view for both eyes; nothing is written");
  }
  NotFinite not_finite;
  BandedImage left = bands_of(both, results[0], not_finite);
  const BandedImage right = bands_of(both, results[1], not_finite);
  left.whole.metadata["caplet.stereo_separation"] = fmt::format("{}", stereo.separation);
  if (stereo.convergence) left.whole.metadata["caplet.stereo_convergence"] = fmt::format("{}", *stereo.convergence);
  Stopwatch phase;
  report::write_stereo_pictures(both.files.picture, both.files.preview, left, right, layout_of(both.options),
                                both.layers.channels(), results[0].render_seconds + results[1].render_seconds);
  not_finite.warn();
  seconds.write = phase.lap();
  RenderResult& out = results[1];
  out.render_seconds += results[0].render_seconds;
  out.camera_rays += results[0].camera_rays;
  out.bounce_rays += results[0].bounce_rays;
  out.shadow_rays += results[0].shadow_rays;
  return std::move(out);
}

void tell_of_bar(const Options& options, const Scene& scene) {
  const post::BarOnPicture bar = post::bar_of(*options.overlays.scale_bar, scene, "--scale-bar");
  log::info("scale bar: {} are {:.1f} pixels{}", bar.label, bar.pixels,
            bar.distance ? fmt::format(" at {:.6g} before the camera, the middle of what is seen (--orthographic: everywhere)",
                                       *bar.distance)
                         : std::string());
}

void run_render(const Options& options, const Invocation& invocation) {
  Stopwatch total, phase;
  report::RunSeconds seconds;
  log::set_quiet(options.quiet);
  Files files;
  const Overrides overrides = check_options(options, files);
  if (!options.display.empty()) parse_tev_address(options.display, "--display");
  const Layers layers = parse_layers(options.layers, options.variance);
  const Layers film_layers = Layers::of_bits(layers.bits() | options.overlays.layers().bits());
  install_interrupt_handlers();
  std::vector<Device> devices = choose_devices(options.device, options.encoding);

  phase.lap();
  Scene scene = import_scene(options.scene, FileImageReader(), options.import_options);
  apply(overrides, scene);
  check_outputs(options, scene, layers, files);
  post::check(options.overlays, scene);
  if (options.overlays.scale_bar && !options.quiet) tell_of_bar(options, scene);
  widen_to_least(scene);
  seconds.load = phase.lap();
  const FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  seconds.build = phase.lap();
  if (interrupt_requested()) throw RunError(interrupted_early);

  devices = tried_apart(devices, {.shapes = flat.shapes, .render = true});
  guard(devices);
  if (!options.quiet)
    log::info("{}: {} primitives, {} x {} pixels, {} samples per pixel on {}", options.scene, flat.primitive_count,
              view.view.crop_width, view.view.crop_height, scene.sampler.samples_per_pixel, names_of(devices));
  RenderOptions render_options;
  render_options.samples_per_pixel = scene.sampler.samples_per_pixel;
  render_options.time_limit = options.time_limit;
  render_options.batch_paths = options.batch_paths;
  render_options.time_stages = !options.stats.empty();
  render_options.film_on_device = true;
  render_options.cancelled = interrupt_requested;
  render_options.layers = film_layers;
  render_options.patience = options.patience;
  const Work work{options, invocation, scene, flat, devices, layers, film_layers, files, render_options};
  const RenderResult result = options.separation ? stereo_pictures(work, seconds) : one_picture(work, view, seconds);
  seconds.total = total.lap();
  if (!files.stats.empty()) write_bytes(files.stats, report::to_text(report::run_summary(seconds, result)));
  const fs::path& first = files.picture.empty() ? files.preview.empty() ? files.stats : files.preview : files.picture;
  if (result.interrupted)
    log::warn("interrupted: {} holds {} of {} samples per pixel", first.string(), result.samples_per_pixel,
              scene.sampler.samples_per_pixel);
  log::info("wrote {}", first.string());
}

}  // namespace

void add_render(CLI::App& app, const Invocation& invocation) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "Render a scene file to an OpenEXR picture");
  command->add_option("SCENE", o->scene, "Scene file: " + scene_extensions())->required();
  command->add_option("-o,--output", o->output, "Picture to write, .exr (default: the scene's own name, here); none: no picture")
      ->type_name("OUT.exr|none");
  command->add_option("--preview", o->preview, "Also write a tone-mapped 8-bit picture (.png, .jpg, .tif...)")->type_name("FILE");
  command->add_option("--spp", o->samples_per_pixel, "Samples per pixel")->check(CLI::Range(1, 1 << 24))->type_name("N");
  command->add_option("--size", o->size, "Picture size in pixels; an automatic camera frames anew")->type_name("WxH");
  command->add_option("--crop", o->crop, "Render only these pixels (from the top left; x1, y1 excluded)")
      ->type_name("x0,y0,x1,y1");
  command
      ->add_option(
          "--device", o->device,
          "OpenCL device: index, cpu, gpu or part of its name (see `caplet devices`); some of these between commas, or all")
      ->type_name("D");
  add_encoding(*command, o->encoding);
  command->add_option("--patience", o->patience, "Leave a device out that does not answer for so long, where there are others")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str()
      ->type_name("SECONDS");
  command->add_option("--seed", o->seed, "Seed of the samples")->type_name("S");
  command->add_option("--max-depth", o->max_depth, "Most scattering events of a path")
      ->check(CLI::Range(0, 1 << 16))
      ->type_name("N");
  command
      ->add_option(
          "--clamp", o->clamp,
          "Greatest component of a sample, exposed, as pbrt's maxcomponentvalue: fewer fireflies, a darker picture; 0: none")
      ->check(CLI::Range(0.0, 1e30))
      ->type_name("X");
  command->add_option("--time", o->time_limit, "Stop after the sample pass that passes this limit")
      ->check([](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return std::isfinite(value) && value > 0 ? std::string() : "'" + text + "' is not a positive number of seconds";
      })
      ->type_name("SECONDS");
  command
      ->add_option("--layers", o->layers,
                   "Layers beside R G B A: some of Z,albedo,N,P,object,primitive,variance, or all, or none")
      ->type_name("LIST");
  command->add_option("--stereo", o->separation, "Render for two eyes, so far apart, into one multi-view EXR")
      ->check(CLI::Range(1e-18, 1e18))
      ->type_name("SEPARATION");
  command->add_option("--convergence", o->convergence, "Distance at which both eyes see things at one place (default: none)")
      ->check(CLI::Range(1e-18, 1e18))
      ->type_name("DISTANCE");
  command->add_option("--stereo-layout", o->layout, "How the preview shows both views: sbs (default), over-under or anaglyph")
      ->check(CLI::IsMember(std::vector<std::string>(report::stereo_layout_names.begin(), report::stereo_layout_names.end())))
      ->type_name("LAYOUT");
  command->add_option("--display", o->display, "Show the picture in tev as it grows, such as 127.0.0.1:14158")
      ->type_name("HOST:PORT");
  command->add_flag("--variance", o->variance, "Also write variance.R/G/B: the variance of each pixel's mean");
  command->add_option("--stats", o->stats, "Write times, ray counts and memory as JSON; -: to stdout")->type_name("FILE.json");
  command->add_flag("-q,--quiet", o->quiet, "No progress, only warnings and errors");
  command->add_option("--batch", o->batch_paths, "Paths a batch (the picture does not depend on it)")->group("");
  add_import_options(*command, o->import_options);
  add_overlays(*command, o->overlays);
  command->footer(
      "Options override the scene file. Ctrl-C finishes the sample pass and writes what there is; a second one stops at once.\n"
      "The picture is scene-linear, with layers albedo, N, P, Z, object.id and primitive.id.");
  command->callback([o, &invocation] { run_render(*o, invocation); });
}

}  // namespace caplet::cli
