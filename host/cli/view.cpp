// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet view`: shows the live scene in a browser.
#include "view/viewer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/options.h"
#include "cli/trial.h"
#include "device/second_try.h"
#include "film/denoise.h"
#include "film/sample_plan.h"
#include "import/import.h"
#include "lower/live_scene.h"
#include "render/device_scene.h"
#include "view/addresses.h"

namespace caplet::cli {

namespace {

struct ViewFlags {
  Encoding encoding = Encoding::automatic;
  std::vector<std::string> scenes;
  std::string device, size, host = "127.0.0.1";
  ImportOptions import_options;
  std::uint16_t port = 0;
  int samples = 0;
  std::optional<double> noise;
  bool no_browser = false, read_only = false, embed = false, no_denoise = false, quiet = false;
};

/// Opens the desktop's browser, if there is a desktop, and leaves errors to it.
void open_browser(const std::string& address) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_RDWR, 0);
  std::string program = "xdg-open", argument = address;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (::posix_spawnp(&child, program.c_str(), &silent, nullptr, arguments, environ) == 0)
    std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
  posix_spawn_file_actions_destroy(&silent);
}

/// Returns the options that make a different scene of the same file.
view::Keeper::ReadAs read_as(const ImportOptions& options) {
  view::Keeper::ReadAs out = options.values();
  std::erase_if(out, [](const auto& value) {
    const auto row = std::ranges::find(import_option_rows(), value.first, &ImportOptionRow::name);
    return row != import_option_rows().end() && row->of == ImportOptionRow::Of::reading;
  });
  return out;
}

/// Returns how the scene's files are read again with other options of their formats.
view::SceneFiles files_of(const std::vector<std::string>& paths, const std::string& name,
                          const ImportOptions& options) {
  view::SceneFiles out;
  view::FileOptions others = options.values();
  for (const ImportOptionRow& row :
       format_options_of(std::vector<std::filesystem::path>(paths.begin(), paths.end()))) {
    if (row.name == "camera") continue;
    out.options.push_back({row.name, row.values, row.help, row.is_list});
    if (const auto now = others.extract(row.name)) out.now[row.name] = now.mapped();
  }
  if (out.options.empty()) return {};
  out.read = [paths, name, others](view::FileOptions all) {
    all.insert(others.begin(), others.end());
    Scene scene = import_files(paths, ImportOptions(std::move(all)));
    scene.source = name;
    return scene;
  };
  return out;
}

/// Describes what others can do if they reach the address.
std::string opened_to(const ViewFlags& options, bool saves, std::uint16_t port) {
  std::vector<std::string> where;
  for (const std::string& address : view::addresses_reached(options.host))
    where.push_back(view::authority_of(address, port));
  const char* what = options.read_only ? "can look at the scene"
                     : saves
                         ? "can look at the scene, change it, and save it as files in its folder"
                         : "can look at the scene and change it";
  return fmt::format(
      "--host {}: every machine that reaches this one at {} and knows the page's address {}{}; "
      "nothing is encrypted",
      options.host, fmt::join(where, ", "), what,
      options.read_only ? "" : " (--read-only: look alone)");
}

void run_view(const ViewFlags& options) {
  log::set_quiet(options.quiet);
  Overrides overrides;
  if (!options.size.empty()) overrides.size = parse_size(options.size);
  install_interrupt_handlers();
  const Device device = choose_device(options.device, options.encoding);
  const std::string name = scene_names(options.scenes);
  std::unique_ptr<view::Keeper> keeper;
  // If several files make one scene, its changes belong to none of them.
  if (!options.read_only && options.scenes.size() == 1 && std::filesystem::is_regular_file(name))
    keeper = std::make_unique<view::Keeper>(name, read_as(options.import_options));
  const std::vector<std::string> paths =
      keeper ? std::vector{keeper->base().string()} : options.scenes;
  Scene scene = import_files(paths, options.import_options);
  if (keeper) {
    scene.source = name;
    keeper->has_read(noted_inputs());
    forget_input(name);  // it may be overwritten, but not the files that it names
  }
  apply(overrides, scene);
  LiveScene live(std::move(scene));
  try_device_apart(device, {.shapes = live.flat().shapes, .render = true, .nearest = true},
                   [&](const Device& on) { return render_jobs(on, live.flat(), live.view()); });
  SecondTry::guard(device);
  view::ViewerOptions viewer_options;
  viewer_options.server.host = options.host;
  viewer_options.server.port = options.port;
  viewer_options.server.token =
      options.port ? view::kept_token(options.host, options.port, name) : view::random_token();
  viewer_options.server.is_embedded = options.embed;
  viewer_options.files = files_of(paths, name, options.import_options);
  viewer_options.read_only = options.read_only;
  viewer_options.denoises = !options.no_denoise && has_denoiser();
  viewer_options.samples = options.samples;
  if (options.noise) {
    viewer_options.noise = *options.noise;
    if (options.samples == 0) viewer_options.samples = narrow<int>(NoiseTarget{}.most);
  }
  const bool saves = keeper != nullptr;
  view::Viewer viewer(std::move(live), device, viewer_options, std::move(keeper));
  SecondTry::driver_works();
  if (!view::is_this_machine_alone(options.host))
    log::warn("{}", opened_to(options, saves, viewer.port()));
  fmt::print("{}\n", viewer.address());
  std::fflush(stdout);
  log::info("{} is at the address above, on {}; Ctrl-C ends it", name, device.info().name);
  if (!options.no_browser) open_browser(viewer.address());
  while (!interrupt_requested()) viewer.wait(0.1);
  if (const auto kept = viewer.end())
    log::info(
        "changes that are not saved are kept in {}: the next `caplet view` of this scene has them "
        "again",
        kept->string());
}

}  // namespace

void add_view(CLI::App& app) {
  const auto o = std::make_shared<ViewFlags>();
  CLI::App* command = app.add_subcommand(
      "view", "Show a scene live in a browser: orbit, pick, every crossing of a ray");
  add_scene_files(*command, o->scenes);
  command->option_defaults()->group("Server");
  command
      ->add_option("--host", o->host,
                   "Address to listen at; 127.0.0.1 is for this machine alone, 0.0.0.0 for all "
                   "that reach it")
      ->capture_default_str()
      ->type_name("ADDRESS");
  command->add_option("--port", o->port, "Port to listen at; 0: any that is free")
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--no-browser", o->no_browser, "Print the address, and open no browser");
  command->add_flag("--read-only", o->read_only, "Let nobody change the scene");
  command->add_flag("--embed", o->embed,
                    "Let pages of this machine, as notebooks are, show the viewer in a frame");
  command->option_defaults()->group("Picture");
  command
      ->add_option("--spp", o->samples,
                   "Samples per pixel at which the picture is done (default: the scene's own)")
      ->check(CLI::Range(1, 1 << 24))
      ->type_name("N");
  command
      ->add_option_function<std::string>(
          "--noise", [o](const std::string& text) { o->noise = parse_noise(text); },
          "Noise at which the picture is done, with --spp samples at most")
      ->type_name("PERCENT%");
  command
      ->add_option("--size", o->size,
                   "Size in pixels of the first picture; the page asks for its own")
      ->type_name("WxH");
  command->add_flag("--no-denoise", o->no_denoise,
                    "Show pictures with their noise, where Open Image Denoise is there");
  command->option_defaults()->group("Device");
  add_device(*command, o->device);
  add_encoding(*command, o->encoding);
  command->option_defaults()->group("Server");
  command->add_flag("-q,--quiet", o->quiet, "Only warnings and errors");
  add_import_options(*command, o->import_options);
  command->footer(
      footer_with({"caplet view scene.pbrt", "caplet view scene.pbrt --port 8080 --no-browser"},
                  "Whoever knows the address sees the scene. Its first part is drawn anew at each "
                  "start; with --port it stays, so that open "
                  "pages go on when the program is started again. Unsaved changes are kept beside "
                  "the scene and are there at the next "
                  "start."));
  command->callback([o] { run_view(*o); });
}

}  // namespace caplet::cli
