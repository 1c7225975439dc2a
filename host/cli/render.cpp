// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet render`: renders a scene file to pictures.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/film_output.h"
#include "cli/frame_source.h"
#include "cli/frames.h"
#include "cli/noise_options.h"
#include "cli/options.h"
#include "cli/overlays.h"
#include "cli/presets.h"
#include "cli/render_files.h"
#include "cli/render_flags.h"
#include "cli/trees.h"
#include "cli/trial.h"
#include "device/second_try.h"
#include "display/tev.h"
#include "film/deep.h"
#include "film/denoise.h"
#include "film/develop.h"
#include "film/image.h"
#include "import/import.h"
#include "lower/fingerprint.h"
#include "lower/live_scene.h"
#include "lower/lower.h"
#include "present/film_window.h"
#include "present/least_width.h"
#include "present/present.h"
#include "present/stereo.h"
#include "present/turntable.h"
#include "render/device_scene.h"
#include "render/render.h"
#include "report/bands.h"
#include "report/denoised.h"
#include "report/mattes.h"
#include "report/picture.h"
#include "report/stereo.h"
#include "report/summary.h"
#include "scene/append.h"
#include "scene/frozen.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* no_picture = "none";

void check_film_options(const RenderFlags& options) {
  const FilmFlags& film = options.film;
  const char* flag = !film.film.empty()      ? "--film"
                     : film.checkpoint       ? "--checkpoint"
                     : film.resume           ? "--resume"
                     : !film.samples.empty() ? "--samples"
                                             : nullptr;
  if (flag && options.has_frames())
    throw InputError(
        SourceLocation{flag},
        "does not go with --turntable, --frames, --poses and --play, which --skip-existing goes on "
        "with");
  if (flag && options.separation)
    throw InputError(SourceLocation{flag}, "does not go with --stereo");
}

void check_frame_options(const RenderFlags& options, const Files& files) {
  const auto refuse = [](const char* flag, const std::string& why) {
    throw InputError(SourceLocation{flag}, why);
  };
  if (!options.has_frames()) {
    if (options.shutter > 0)
      refuse("--shutter", "goes with --turntable, --frames, --poses and --play");
    if (options.skip_existing)
      refuse("--skip-existing", "goes with --turntable, --frames, --poses or --play");
    return;
  }
  if (options.separation) refuse("--stereo", "does not go with frames");
  if (!options.display.empty()) refuse("--display", "does not go with frames");
  if (options.skip_existing && !files.movie.empty())
    refuse("--skip-existing", "does not go with a movie, which has all frames");
  const auto check_numbered = [&](const char* flag, const fs::path& path) {
    if (!is_numbered(path.string()))
      refuse(flag, fmt::format("'{}': frames are written to numbered files, such as {}.####{}",
                               path.string(), path.stem().string(), path.extension().string()));
  };
  for (const auto* paths : {&files.pictures, &files.previews})
    for (const fs::path& path : *paths) check_numbered("-o", path);
  if (!files.deep.empty()) check_numbered("--deep", files.deep);
  if (!files.depth.empty()) check_numbered("--depth", files.depth);
  if (files.pictures.empty() && files.previews.empty() && files.movie.empty() &&
      files.depth.empty())
    refuse("-o", "frames need a name, such as frame.####.png or movie.mp4");
}

/// Reports errors in options and outputs before anything is loaded.
Overrides check_options(const RenderFlags& options, Files& files) {
  Overrides overrides;
  if (!options.size.empty()) overrides.size = parse_size(options.size);
  if (!options.crop.empty()) overrides.crop = parse_crop(options.crop);
  overrides.samples_per_pixel = options.samples_per_pixel;
  overrides.max_depth = options.max_depth;
  overrides.seed = options.seed;
  overrides.clamp = options.clamp;
  overrides.denoise = options.denoise;
  overrides.matte_levels = options.mattes.levels;
  if (options.denoise) check_denoiser("--denoise");
  if (!options.separation && (options.convergence || !options.layout.empty()))
    throw InputError(SourceLocation{options.convergence ? "--convergence" : "--stereo-layout"},
                     "goes with --stereo");
  const bool none = std::ranges::find(options.outputs, no_picture) != options.outputs.end();
  if (none && options.outputs.size() > 1)
    throw InputError(SourceLocation{"-o"}, "'none' does not go with another -o");
  if (none && options.preview.empty() && options.stats.empty() && options.film.film.empty() &&
      options.mattes.deep.empty() && options.depth.file.empty())
    throw InputError(
        SourceLocation{"-o"},
        "'none' goes with --preview, --deep, --depth, --film or --stats: nothing would be written");
  for (const std::string& output : options.outputs)
    if (output != no_picture) add_output(options, files, output_named(output));
  if (!options.preview.empty()) add_preview(files, options.preview, "--preview");
  if (!options.mattes.deep.empty()) {
    if (options.separation) throw InputError(SourceLocation{"--deep"}, "does not go with --stereo");
    files.deep = deep_path(options.mattes);
    files.all.add("--deep", files.deep);
  }
  files.depth = depth_path(options.depth);
  if (!files.depth.empty()) {
    if (options.separation)
      throw InputError(SourceLocation{"--depth"}, "does not go with --stereo");
    files.all.add("--depth", files.depth);
  }
  if (options.overlays.any() &&
      ((files.previews.empty() && files.movie.empty()) || options.separation))
    throw InputError(SourceLocation{"--preview"},
                     options.separation ? "overlays are not drawn for two eyes (--stereo)"
                                        : "overlays are drawn on it alone");
  if (!options.stats.empty()) {
    files.stats = output_named(options.stats);
    files.all.add("--stats", files.stats);
  }
  check_frame_options(options, files);
  check_film_options(options);
  noise_target(options);
  return overrides;
}

report::StereoLayout layout_of(const RenderFlags& options) {
  const auto found = std::ranges::find(report::stereo_layout_names, options.layout);
  return found == report::stereo_layout_names.end()
             ? report::StereoLayout::side_by_side
             : static_cast<report::StereoLayout>(found - report::stereo_layout_names.begin());
}

/// Checks what depends on the scene: the picture's name (the scene's own film name, else the scene
/// file's, in the current folder), its size, and that no output is a file that the scene was read
/// from.
void check_outputs(const RenderFlags& options, const Scene& scene, Layers layers, Files& files) {
  if (options.outputs.empty() && !options.has_frames() && options.film.film.empty() &&
      options.mattes.deep.empty() && options.depth.file.empty()) {
    fs::path name = fs::path(scene.view.film.filename).filename();
    if (name.empty()) name = fs::path(options.scenes.front()).filename();
    add_output(options, files, name.replace_extension(".exr"));
  }
  files.film = film_path(options, files);
  if (!files.film.empty()) files.all.add("--film", files.film);
  if ((options.film.checkpoint || options.film.resume) && is_stream(files.film))
    throw InputError(SourceLocation{"--film"}, "checkpoints and --resume need a file");
  files.all.check_inputs();
  const std::array<int, 4> window = scene.view.film.crop.value_or(
      std::array<int, 4>{0, scene.view.film.width, 0, scene.view.film.height});
  const int width = window[1] - window[0], height = window[3] - window[2];
  const std::string flag = options.crop.empty() ? "--size" : "--crop";
  if (!files.pictures.empty())
    check_exr_size(width, height,
                   (layers.channels(scene.view.film.matte_levels) +
                    (scene.view.film.denoise ? report::denoising_channels : std::size_t{0})) *
                       (options.separation ? 2 : 1),
                   flag);
  check_depth(options.depth, scene.view.camera, options.turntable > 0 && options.shutter > 0);
  if (files.depth.extension() == ".png") check_preview_size(files.depth, width, height, flag);
  const bool is_transparent =
      scene.view.film.backdrop && scene.view.film.backdrop->kind == Backdrop::Kind::transparent;
  for (const fs::path& preview : files.previews) {
    if (is_transparent && !options.separation) check_preview_alpha(preview, "--preview");
    check_preview_size(
        preview,
        options.separation && layout_of(options) == report::StereoLayout::side_by_side ? 2 * width
                                                                                       : width,
        options.separation && layout_of(options) == report::StereoLayout::over_under ? 2 * height
                                                                                     : height,
        flag);
  }
}

/// Is thrown when an interrupt comes before there is anything to write.
struct InterruptedEarly : RunError {
  static constexpr const char* message =
      "interrupted before anything was rendered; nothing is written";
  InterruptedEarly() : RunError(message) {}
};

/// Returns the last words of a program that is ended while it prepares a render, as of
/// InterruptedEarly.
std::string ended_early(bool keeps_film) {
  return fmt::format("caplet: {}: {}\n", keeps_film ? "warning" : "error",
                     InterruptedEarly::message);
}

void guard(const std::vector<Device>& devices) {
  for (const Device& device : devices) SecondTry::guard(device);
}

std::string names_of(const std::vector<Device>& devices) {
  std::string out;
  for (const Device& device : devices) out += (out.empty() ? "" : " and ") + device.info().name;
  return out;
}

/// Returns the result of `work`, and reports its progress.
template <class Work>
RenderResult with_progress(const std::vector<Device>& devices, const RenderOptions& render_options,
                           bool quiet, const Work& work) {
  ProgressReporter reporter(ProgressReporter::style_for_stderr(quiet));
  try {
    return work([&](const Progress& progress) {
      renew_user_signal_handler();  // a compiler may have replaced it
      if (progress.samples_done > 0 || progress.fraction >= 1)
        SecondTry::driver_works();
      else
        guard(devices);  // once more, because the kernels' compiler may have set signal handlers
      reporter.update(
          progress.fraction, progress.samples_per_second,
          progress.noise
              ? fmt::format("{} samples, noise {:.1f} %", progress.samples_done,
                            100 * *progress.noise)
              : fmt::format("{:.0f}/{} samples",
                            std::floor(progress.fraction * render_options.samples_per_pixel + 1e-6),
                            render_options.samples_per_pixel));
    });
  } catch (const RunError&) {
    // A driver's compiler may fail because of the signal; the interrupt is then the reason, not the
    // driver.
    if (interrupt_requested()) throw InterruptedEarly();
    throw;
  }
}

/// The inputs and settings of a picture.
struct Work {
  const RenderFlags& options;
  const Invocation& invocation;
  const Scene& scene;
  const FlatScene& flat;
  const std::vector<Device>& devices;
  Layers layers, film_layers;  // the layers to write, and those with the ones that overlays need
  const Files& files;
  RenderOptions render_options;
  FilmOutput* film = nullptr;              // where the film is kept
  std::optional<double>* stops = nullptr;  // of the first of several frames, for all of them
  FlatScene* spent = nullptr;  // `flat`, where nothing needs it once the device has it; or null
  const post::Sight* sight = nullptr;  // of the scene, where it is known; or null
};

std::map<std::string, std::string> notes_of(const Work& work, const RenderResult& result) {
  auto notes = report::picture_metadata(work.scene, scene_names(work.options.scenes),
                                        work.invocation.command_line(), result);
  notes.merge(report::matte_attributes(work.scene, work.layers));
  return work.film ? work.film->notes(notes) : notes;
}

/// Returns what is known of a render that is not done.
RenderResult so_far(const Work& work, int samples, double seconds) {
  RenderResult out;
  out.samples_per_pixel = samples;
  out.render_seconds = seconds;
  out.interrupted = true;
  for (const Device& device : work.devices) out.devices.push_back(work_of(device.info()));
  return out;
}

/// Returns the look that writes checkpoints.
Look checkpoints(const Work& work) {
  const double interval = *work.options.film.checkpoint;
  const Clock::time_point start = Clock::now();
  return {interval, [&work, interval, start](const Film& film) {
            const RenderResult result =
                so_far(work, narrow<int>(std::lround(film.mean_samples())), seconds_since(start));
            work.film->checkpoint(film, notes_of(work, result), interval);
          }};
}

RenderResult render_with_progress(const Work& work, const FlatView& view,
                                  const RenderOptions& render_options) {
  return with_progress(work.devices, render_options, work.options.quiet,
                       [&](const std::function<void(const Progress&)>& progress) {
                         const SessionOptions session_of = session_options(render_options);
                         Session session =
                             work.spent
                                 ? Session(std::move(*work.spent), view, work.devices, session_of)
                                 : Session(work.flat, view, work.devices, session_of);
                         if (work.film)
                           work.film->resume(session, render_options.sample_begin,
                                             notes_of(work, so_far(work, 0, 0)));
                         return render(session, work.devices, render_options, progress);
                       });
}

/// Renders a view; if requested, tev shows its progress.
RenderResult render_shown(const Work& work, const FlatView& view, const std::string& view_name) {
  RenderOptions shown = work.render_options;
  if (work.film && work.options.film.checkpoint) shown.looks.push_back(checkpoints(work));
  if (work.options.display.empty()) return render_with_progress(work, view, shown);
  constexpr double most_seconds_at_the_end = 5;
  const std::string name = (work.files.pictures.empty() ? fs::path(work.options.scenes.front())
                                                        : work.files.pictures.front())
                               .filename()
                               .string();
  TevDisplay display(parse_tev_address(work.options.display, "--display"),
                     view_name.empty() ? name : name + " (" + view_name + ")");
  PictureFlaws ignored;
  shown.film_on_device = false;
  shown.looks.push_back({1, [&](const Film& film) {
                           if (display.is_idle())
                             display.show(
                                 develop(film, work.scene.view.film, work.layers, ignored));
                         }});
  RenderResult result = render_with_progress(work, view, shown);
  display.show(develop(result.film, work.scene.view.film, work.layers, ignored));
  display.finish(most_seconds_at_the_end);
  return result;
}

void add_to(report::RunSeconds& seconds, const RenderResult& result) {
  seconds.compile += result.compile_seconds;
  seconds.render += result.render_seconds;
}

BandedImage bands_of(const Work& work, const RenderResult& result, PictureFlaws& flaws) {
  BandedImage out =
      result.device_film
          ? report::developed(*result.device_film, work.scene.view.film, work.film_layers, flaws)
          : report::developed(result.film, work.scene.view.film, work.film_layers, flaws);
  out.whole.metadata = notes_of(work, result);
  if (work.scene.view.film.denoise) out.whole.metadata["caplet.denoiser"] = denoiser_name();
  return out;
}

/// Calls write with a picture and a preview at a time, which are developed together; one of them
/// may be empty.
template <class Write>
void each_pair(const Files& files, const Write& write) {
  for (std::size_t i = 0; i < std::max(files.pictures.size(), files.previews.size()); ++i)
    write(i < files.pictures.size() ? files.pictures[i] : fs::path(),
          i < files.previews.size() ? files.previews[i] : fs::path());
}

std::size_t channels_of(const Work& work) {
  return work.layers.channels(work.scene.view.film.matte_levels) +
         (work.scene.view.film.denoise ? report::denoising_channels : std::size_t{0});
}

/// Returns what reads rows of the film, wherever it is.
std::function<Film(int, int)> rows_of(const RenderResult& result) {
  return [&result](int first, int count) {
    return result.device_film ? result.device_film->read(first, count)
                              : result.film.rows(first, count);
  };
}

const FilmLayout& layout_of(const RenderResult& result) {
  return result.device_film ? result.device_film->layout : result.film.layout();
}

void write_deep(const Work& work, const RenderResult& result) {
  write_deep_exr(work.files.deep, layout_of(result), rows_of(result), notes_of(work, result));
}

void write_depths(const Work& work, const RenderResult& result) {
  const DepthPicture picture =
      depth_picture(work.options.depth, work.files.depth, work.scene.view.camera);
  auto notes = notes_of(work, result);
  notes["caplet.depth"] = picture.plane ? "planar" : "range";
  const FilmLayout& layout = layout_of(result);
  if (const std::size_t beyond = write_depth(picture, layout, rows_of(result), notes); beyond > 0)
    log::warn("{}: {} of {} pixels lie beyond 1 to 65535 steps of {:g} and are 0",
              picture.path.string(), beyond, layout.window.pixels(), picture.unit);
}

/// Fixes the exposure of the previews, and tells of one that the pictures have chosen.
void expose(const Work& work, std::span<BandedImage> pictures, PictureFlaws& flaws) {
  if (work.files.previews.empty() || !work.scene.view.film.exposure.is_automatic) return;
  if (work.stops && *work.stops) return report::set_exposure(pictures, **work.stops);
  const double stops = report::fix_exposure(pictures, flaws);
  if (work.stops) *work.stops = stops;
  log::info("exposure of previews: {:.2f} stops", stops);
}

RenderResult written(const Work& work, RenderResult result, report::RunSeconds& seconds) {
  add_to(seconds, result);
  if (!work.files.deep.empty()) write_deep(work, result);
  if (!work.files.depth.empty()) write_depths(work, result);
  if (work.files.pictures.empty() && work.files.previews.empty()) return result;
  PictureFlaws flaws;
  Stopwatch phase;
  BandedImage picture = bands_of(work, result, flaws);
  const double developed = phase.lap();
  if (work.scene.view.film.denoise) seconds.denoise += developed;
  expose(work, {&picture, 1}, flaws);
  const post::Overlays& overlays = work.options.overlays;
  report::Finish finish{overlays.layers(), work.layers, {}};
  if (overlays.any())
    finish.draw = [&](Shown& shown, const LayeredImage& layers) {
      post::draw(shown, layers, work.sight ? *work.sight : post::Sight(work.scene), overlays);
    };
  each_pair(work.files, [&](const fs::path& exr, const fs::path& preview) {
    report::write_pictures(exr, preview, picture, channels_of(work), result.render_seconds, finish);
  });
  flaws.warn();
  result.noise = flaws.noise.in({work.options.noise_space.value_or(work.scene.view.sampler.space()),
                                 work.scene.view.film.exposure});
  seconds.write += phase.lap();
  return result;
}

RenderResult one_picture(const Work& work, const FlatView& view, report::RunSeconds& seconds) {
  RenderResult result = render_shown(work, view, "");
  std::exception_ptr failure;  // is thrown when the pictures are written as well
  if (work.film) try {
      work.film->finish(result.film, notes_of(work, result), result.render_seconds);
    } catch (const RunError&) {
      failure = std::current_exception();
    }
  result = written(work, std::move(result), seconds);
  if (failure) std::rethrow_exception(failure);
  return result;
}

/// Renders the views of two eyes in turn, the right one with as many samples as the left one got.
/// The result describes both.
RenderResult stereo_pictures(const Work& both, report::RunSeconds& seconds) {
  const Stereo stereo{*both.options.separation, both.options.convergence};
  std::array<RenderResult, 2> results;
  for (const Eye eye : {Eye::left, Eye::right}) {
    Work work = both;
    work.render_options.film_on_device = false;
    if (work.render_options.time_limit) *work.render_options.time_limit /= 2;
    Scene seen;
    seen.view = both.scene.view;
    seen.view.camera = camera_of_eye(both.scene, stereo, eye);
    const std::size_t i = eye == Eye::left ? 0 : 1;
    if (i == 1) work.render_options.samples_per_pixel = results[0].samples_per_pixel;
    if (i == 1) work.render_options.time_limit.reset();
    results[i] = render_shown(work, lower_view(seen), eye == Eye::left ? "left" : "right");
    add_to(seconds, results[i]);
    if (results[i].interrupted && i == 0)
      throw RunError("interrupted before there was a view for both eyes; nothing is written");
  }
  PictureFlaws flaws;
  Stopwatch phase;
  std::array<BandedImage, 2> eyes{bands_of(both, results[0], flaws),
                                  bands_of(both, results[1], flaws)};
  BandedImage& left = eyes[0];
  const double developed = phase.lap();
  if (both.scene.view.film.denoise) seconds.denoise += developed;
  expose(both, eyes, flaws);
  left.whole.metadata["caplet.stereo_separation"] = fmt::format("{}", stereo.separation);
  if (stereo.convergence)
    left.whole.metadata["caplet.stereo_convergence"] = fmt::format("{}", *stereo.convergence);
  each_pair(both.files, [&](const fs::path& exr, const fs::path& preview) {
    report::write_stereo_pictures(exr, preview, left, eyes[1], layout_of(both.options),
                                  channels_of(both),
                                  results[0].render_seconds + results[1].render_seconds);
  });
  flaws.warn();
  seconds.write = phase.lap();
  RenderResult& out = results[1];
  out.render_seconds += results[0].render_seconds;
  out.camera_rays += results[0].camera_rays;
  out.bounce_rays += results[0].bounce_rays;
  out.shadow_rays += results[0].shadow_rays;
  return std::move(out);
}

void tell_of_bar(const RenderFlags& options, const post::Sight& sight) {
  const post::BarOnPicture bar = post::bar_of(*options.overlays.scale_bar, sight, "--scale-bar");
  log::info("scale bar: {} are {:.1f} pixels{}", bar.label, bar.pixels,
            bar.distance ? fmt::format(" at {:.6g} before the camera, the middle of what is seen "
                                       "(--orthographic: everywhere)",
                                       *bar.distance)
                         : std::string());
}

// --- Frames ---

/// Frames an automatic camera to the union of up to 17 frames, including the first and the last.
void frame_all(const RenderFlags& options, const FrameSource& source, const Overrides& overrides,
               Scene& first) {
  constexpr std::uint32_t most = 16;
  if (!first.automatic_camera) return;
  Scene all = first;
  const std::uint32_t count = source.range.last - source.range.first;
  const bool quiet = options.quiet;
  log::set_quiet(true);  // messages appear when each frame is rendered
  for (std::uint32_t i = 1; i <= std::min(count, most); ++i) {
    const auto frame = source.range.first +
                       static_cast<std::uint32_t>(std::uint64_t{count} * i / std::min(count, most));
    Scene other = scene_of_frame(options, source, frame);
    other.lights.clear();
    append(all, std::move(other));
  }
  log::set_quiet(quiet);
  apply(overrides, all);
  set_film_size(all, all.view.film.width, all.view.film.height);  // frames the camera again
  move_camera(first, all.view.camera);
}

/// Renders the frames one after the other. What they share (the device, its kernels, for a
/// turntable the whole scene) is made once. Throws RunError when it is interrupted: each frame is
/// then either complete or missing.
RenderResult render_frames(const Work& of_all, const FrameSource& source,
                           const Overrides& overrides, Scene scene, report::RunSeconds& seconds) {
  const RenderFlags& options = of_all.options;
  std::optional<Movie> movie;
  if (!of_all.files.movie.empty()) movie.emplace(of_all.files.movie, options.frames_a_second, "-o");
  std::optional<Turntable> table;
  if (source.kind == FrameSource::Kind::turntable) table.emplace(scene);
  const Camera camera = scene.view.camera;
  const std::vector<Light> lights = scene.lights;
  const bool is_automatic = scene.automatic_camera;
  std::optional<Scene> moving;  // what has a time of its own, in which frames have theirs
  if (source.has_times && moves(scene)) moving = scene;
  LiveScene live(std::move(scene));
  std::vector<SceneEdit> undo;  // of a pose: what leads back to the scene
  std::optional<Session> session;
  RenderResult result;
  std::optional<double> stops;
  std::uint32_t made = 0;
  const std::uint32_t count = source.range.last - source.range.first + 1;
  const Clock::time_point began = Clock::now();
  for (std::uint32_t frame = source.range.first; frame <= source.range.last; ++frame) {
    Files files = of_frame(of_all.files, frame);
    if (options.skip_existing && are_there(files)) continue;
    if (movie) files.previews.push_back(movie->next());
    if (interrupt_requested())
      throw RunError(fmt::format("interrupted: {} of {} frames are written", made, count));
    if (table) {
      View view = live.scene().view;
      view.camera = table->camera(frame - 1, source.range.count, options.shutter);
      live.edit(view);
      for (std::uint32_t i = 0; i < lights.size(); ++i)
        if (table->turns(lights[i]))
          live.edit(LightEdit{i, table->turned(lights[i], frame - 1, source.range.count)});
    } else if (moving) {
      live.replace(played(options, source, frame, *moving));
    } else if (source.kind == FrameSource::Kind::poses) {
      for (; !undo.empty(); undo.pop_back()) live.edit(undo.back());
      for (const SceneEdit& edit : edits_of_frame(options, source, frame, live.scene().view.film))
        undo.push_back(live.edit(edit));
    } else if (session || frame != source.range.first) {
      Scene next = scene_of_frame(options, source, frame);
      apply(overrides, next);
      if (options.noise) next.view.sampler.kind = live.scene().view.sampler.kind;
      if (is_automatic) {
        next.view.camera = camera;
        next.lights = lights;
      }
      widen_to_least(next);
      live.replace(std::move(next));
    }
    if (!session)
      session.emplace(live.flat(), live.view(), of_all.devices,
                      session_options(of_all.render_options));
    else
      session->update(live.flat(), live.take_changes(), live.view());
    const Work work{
        options,       of_all.invocation,  live.scene(), live.flat(),           of_all.devices,
        of_all.layers, of_all.film_layers, files,        of_all.render_options, nullptr,
        &stops};
    result = with_progress(of_all.devices, work.render_options, options.quiet,
                           [&](const auto& progress) {
                             return render(*session, of_all.devices, work.render_options, progress);
                           });
    if (result.interrupted)
      throw RunError(fmt::format("interrupted: {} of {} frames are written", made, count));
    result = written(work, std::move(result), seconds);
    ++made;
    if (!files.pictures.empty() || !files.depth.empty() ||
        files.previews.size() > (movie ? 1U : 0U))
      log::info("frame {}: wrote {}", frame, files.first().string());
  }
  if (movie) movie->finish();
  if (made > 0) log::info("{} frames in {:.1f} s", made, seconds_since(began));
  return result;
}

/// Returns what a film's file says besides its samples.
SavedFilm saved_like(const Scene& scene, const std::string& scene_fingerprint, const FlatView& view,
                     bool to_noise) {
  SavedFilm out;
  out.scene = scene_fingerprint;
  out.view = fingerprint(view);
  if (!to_noise)
    out.samples_wanted = static_cast<std::uint32_t>(scene.view.sampler.samples_per_pixel);
  out.settings = scene.view.film;
  return out;
}

/// Returns the options of a render of `samples`. `film_layers`: those to write, and those that
/// overlays need.
RenderOptions render_options_of(const RenderFlags& options, const Scene& scene, const Files& files,
                                const SampleSpan& samples, Layers film_layers, bool keeps_film) {
  RenderOptions out;
  out.sample_begin = samples.begin;
  out.samples_per_pixel = narrow<int>(samples.end - samples.begin);
  out.noise = noise_target(options, scene.view.film.exposure);
  out.time_limit = options.time_limit;
  out.least_samples = narrow<std::uint32_t>(options.least_samples.value_or(0));
  out.batch_paths = options.batch_paths;
  out.time_stages = !options.stats.empty();
  out.film_on_device = !keeps_film;
  out.cancelled = interrupt_requested;
  out.layers = film_layers;
  if (scene.view.film.denoise)
    out.layers = Layers::of_bits(film_layers.bits() | report::denoising_layers().bits());
  if (!files.deep.empty()) out.layers = Layers::of_bits(out.layers.bits() | deep_layers().bits());
  if (!files.depth.empty())
    out.layers =
        Layers::of_bits(out.layers.bits() | depth_layers(options.depth.is_planar()).bits());
  if (options.noise) out.layers = out.layers.with(Layer::variance);
  out.patience = options.patience;
  return out;
}

/// Reads the tree file that is rendered, if it is one. Throws InputError for frames, which need the
/// scene that it was built of.
std::optional<Tree> tree_to_render(const RenderFlags& options) {
  if (!is_tree(options.scenes)) return std::nullopt;
  if (options.has_frames())
    throw InputError({options.scenes.front()},
                     "a tree file has no shapes, which frames need: render the scene itself");
  return read_tree(options.scenes.front(), options.import_options);
}

void run_render(const RenderFlags& given, const Invocation& invocation) {
  Stopwatch total, phase;
  report::RunSeconds seconds;
  log::set_quiet(given.quiet);
  Files files;
  const Overrides overrides = check_options(given, files);
  if (!given.display.empty()) parse_tev_address(given.display, "--display");
  parse_layers(given.layers, given.variance);
  install_interrupt_handlers();
  std::vector<Device> devices = choose_devices(given.device, given.encoding);

  renew_user_signal_handler();  // drivers may have replaced it when they were loaded
  std::optional<EndsAtOnce> early(std::in_place, ended_early(given.film.keeps()),
                                  given.film.keeps() ? exit_stopped : 1);
  phase.lap();
  std::optional<Tree> tree = tree_to_render(given);
  std::optional<FrameSource> frames;
  if (given.has_frames()) frames = source_of(given);
  if (!files.movie.empty())
    Movie(files.movie, given.frames_a_second, "-o");  // checks that it can be made
  Scene scene = tree     ? std::move(tree->scene)
                : frames ? scene_of_frame(given, *frames, frames->range.first)
                         : import_files(given.scenes, given.import_options);
  const RenderFlags options = with_noise_of(scene.view.sampler, given);
  const Layers layers = with_mattes(
      parse_layers(options.layers, options.variance || (options.noise && !options.layers)),
      options.mattes);
  const Layers film_layers = Layers::of_bits(layers.bits() | options.overlays.layers().bits());
  apply(overrides, scene);
  if (options.noise) take_open_sampler(scene.view.sampler);
  if (frames && !frames->has_one_scene()) frame_all(options, *frames, overrides, scene);
  if (scene.view.film.denoise && !options.denoise) check_denoiser("Film \"denoise\"");
  check_outputs(options, scene, layers, files);
  std::optional<post::Sight> sight;
  if (options.overlays.any()) sight = tree ? tree->sight(scene) : post::Sight(scene);
  if (sight) post::check(options.overlays, *sight, "--");
  if (options.overlays.scale_bar && !options.quiet) tell_of_bar(options, *sight);
  widen_to_least(scene);
  if (frames) read_poses_of(options, scene, *frames);
  const auto wanted = static_cast<std::uint32_t>(scene.view.sampler.samples_per_pixel);
  const SampleSpan samples = options.film.samples.empty()
                                 ? SampleSpan{0, wanted}
                                 : parse_samples(options.film.samples, wanted);
  seconds.load = phase.lap();
  // One picture needs the capsules of large scenes in no other form than the device's.
  const bool is_one = !frames && !options.separation;
  std::optional<StepNotice> notice(std::in_place, "building the tree",
                                   ProgressReporter::style_for_stderr(options.quiet));
  FlatScene flat = tree     ? std::move(tree->file.scene)
                   : is_one ? lower_and_release(scene)
                            : lower(scene);
  const FlatView view = lower_view(scene);
  notice.reset();
  early.reset();
  seconds.build = phase.lap();
  if (interrupt_requested()) throw InterruptedEarly();

  devices = tried_apart(devices, {.shapes = flat.shapes, .render = true},
                        [&](const Device& device) { return render_jobs(device, flat, view); });
  guard(devices);
  if (!options.quiet)
    log::info("{}: {} primitives, {} x {} pixels, {} on {}", scene_names(options.scenes),
              flat.primitive_count, view.view.crop_width, view.view.crop_height,
              options.noise ? fmt::format("noise {:g} %", 100 * *options.noise)
                            : fmt::format("{} samples per pixel", samples.end - samples.begin),
              names_of(devices));
  std::optional<FilmOutput> film;
  if (!files.film.empty())
    film.emplace(files.film,
                 saved_like(scene, tree ? tree->file.fingerprint : fingerprint(flat), view,
                            options.noise.has_value()),
                 options.film.resume);
  const RenderOptions render_options =
      render_options_of(options, scene, files, samples, film_layers, film.has_value());
  const Work work{options,
                  invocation,
                  scene,
                  flat,
                  devices,
                  layers,
                  film_layers,
                  files,
                  render_options,
                  film ? &*film : nullptr,
                  nullptr,
                  is_one ? &flat : nullptr,
                  is_one && sight ? &*sight : nullptr};
  const RenderResult result = frames ? render_frames(work, *frames, overrides, scene, seconds)
                              : options.separation ? stereo_pictures(work, seconds)
                                                   : one_picture(work, view, seconds);
  seconds.total = total.lap();
  if (!files.stats.empty())
    write_bytes(files.stats, report::to_text(report::run_summary(seconds, result)));
  const fs::path first = frames && !files.movie.empty() ? files.movie : files.first();
  if (result.reached) tell_of(*result.reached, *render_options.noise);
  if (result.interrupted)
    log::warn("interrupted: {} holds {} samples per pixel", first.string(),
              options.noise ? fmt::format("{}", result.samples_per_pixel)
                            : fmt::format("{} of {}", result.samples_per_pixel,
                                          render_options.samples_per_pixel));
  log::info("wrote {}", first.string());
  if (film && first != files.film) log::info("wrote {}", files.film.string());
  if (film && result.interrupted &&
      (result.reached ? result.reached->noise > *options.noise
                      : result.samples_per_pixel < render_options.samples_per_pixel))
    throw CLI::RuntimeError(exit_stopped);
}

}  // namespace

void add_render(CLI::App& app, const Invocation& invocation) {
  const auto o = std::make_shared<RenderFlags>();
  CLI::App* command = app.add_subcommand("render", "Render a scene file to an OpenEXR picture");
  add_scene_files(*command, o->scenes);
  add_render_flags(*command, *o);
  command->footer(footer_with({"caplet render scene.pbrt -o picture.exr --preview picture.png",
                               "caplet render a.swc b.swc --size 960x540 --spp 64 -o picture.png",
                               "caplet render neuron.swc --turntable 72 -o movie.mp4"},
                              "Options override the scene file. Ctrl-C finishes the sample pass "
                              "and writes what there is; a second one stops at once. "
                              "The picture is scene-linear."));
  command->callback([o, command, &invocation] {
    apply_preset(*command, o->preset);
    try {
      run_render(*o, invocation);
    } catch (const InterruptedEarly& error) {
      if (!o->film.keeps()) throw;
      log::warn("{}", error.what());  // a film of before is as it was
      throw CLI::RuntimeError(exit_stopped);
    }
  });
}

}  // namespace caplet::cli
