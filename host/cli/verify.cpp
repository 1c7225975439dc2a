// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet verify`: compares a device's results with the host reference.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <mutex>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/options.h"
#include "cli/trial.h"
#include "device/second_try.h"
#include "device/self_test.h"
#include "film/image.h"
#include "import/import.h"
#include "report/heatmap.h"
#include "report/verify_report.h"
#include "scene/frozen.h"
#include "verify/cases.h"
#include "verify/torture.h"

namespace caplet::cli {

namespace {

constexpr int exit_disagreed = 3;

struct VerifyFlags {
  Encoding encoding = Encoding::automatic;
  std::vector<std::string> scenes;
  std::string device, heatmap, failures, replay, size;
  ImportOptions import_options;
  std::uint64_t rays = 1'000'000, seed = 0;
  bool all_devices = false, json = false, quiet = false;
};

std::vector<Device> devices_of(const VerifyFlags& o) {
  std::vector<Device> out;
  if (!o.all_devices) {
    out.push_back(choose_device(o.device, o.encoding));
  } else {
    for (const DeviceInfo& info : list_devices())
      out.push_back(Device::choose(std::to_string(info.index), o.encoding));
    if (out.empty()) out.push_back(choose_device("", o.encoding));  // reports what is missing
  }
  for (const Device& device : out) {
    try {
      try_device_apart(device, {.nearest = true, .lists = true});
    } catch (const WrongDevice& wrong) {
      log::warn("{}", wrong.what());  // the errors of the device are what the user asked for
    }
    SecondTry::guard(device);
  }
  return out;
}

std::string scene_label(const verify::SceneName& name) {
  return name.file.empty() ? fmt::format("torture set, seed {}", name.seed) : name.file;
}

/// Repeats every case. Returns true when all agree now.
bool replay(const VerifyFlags& o) {
  const std::vector<verify::Case> cases = verify::load_cases(o.replay);
  const std::vector<Device> devices = devices_of(o);
  std::map<std::tuple<std::string, std::uint64_t, std::uint64_t, float>,
           std::vector<const verify::Case*>>
      by_scene;
  for (const verify::Case& one : cases)
    by_scene[{one.scene.file, one.scene.seed, one.scene.round, one.scene.time}].push_back(&one);
  std::map<const verify::Case*, std::string> wrong;
  for (const auto& group : by_scene) {
    const std::vector<const verify::Case*>& members = group.second;
    const verify::SceneName& name = members.front()->scene;
    const Scene scene = name.file.empty() ? verify::torture_scene(name.seed, name.round)
                                          : import_scene(name.file, FileImageReader());
    std::vector<RayRecord> rays;
    rays.reserve(members.size());
    for (const verify::Case* one : members) rays.push_back(one->ray);
    const bool is_moving = moves(scene);
    const Scene frozen = is_moving ? verify::seen_at(scene, name.time) : Scene{};
    verify::SceneCheck check(is_moving ? frozen : scene, devices, is_moving ? &scene : nullptr,
                             name.time);
    std::mutex mutex;
    check.check(rays, [&](const verify::SceneCheck::Checked& ray) {
      std::string text;
      for (std::size_t d = 0; d < devices.size(); ++d)
        for (const verify::Disagreement& found : ray.outcomes[d].disagreements)
          text +=
              fmt::format("  {}: {}: {}\n", devices[d].info().name,
                          verify::fault_names[static_cast<std::size_t>(found.fault)], found.text);
      const std::lock_guard lock(mutex);
      if (!text.empty()) wrong[members[ray.ray]] = text;
    });
  }
  for (const verify::Case& one : cases) {
    const auto found = wrong.find(&one);
    fmt::print("{}: {}\n{}", one.file.string(), found == wrong.end() ? "agrees" : "DISAGREES",
               found == wrong.end() ? "" : found->second);
  }
  fmt::print("{} of {} cases agree\n", cases.size() - wrong.size(), cases.size());
  return wrong.empty();
}

void run_verify(const VerifyFlags& o) {
  log::set_quiet(o.quiet);
  const auto refuse = [](const char* flag, const char* why) {
    throw InputError(SourceLocation{flag}, why);
  };
  if (o.all_devices && !o.device.empty()) refuse("--device", "does not go with --all-devices");
  if (!o.replay.empty()) {
    if (!o.scenes.empty()) refuse("--replay", "takes the scene from the cases");
    if (!o.heatmap.empty()) refuse("--heatmap", "does not go with --replay");
    if (!o.failures.empty()) refuse("--save-failures", "does not go with --replay");
    if (o.json) refuse("--json", "does not go with --replay");
    if (!replay(o)) throw CLI::RuntimeError(exit_disagreed);
    return;
  }
  Outputs outputs;
  if (!o.heatmap.empty()) {
    if (!o.heatmap.ends_with(".exr") && !is_stream(o.heatmap))
      refuse("--heatmap", "writes EXR: the name must end in .exr");
    outputs.add("--heatmap", o.heatmap);
  }
  if (!o.size.empty() && o.heatmap.empty()) refuse("--size", "goes with --heatmap");
  Overrides overrides;
  if (!o.size.empty()) overrides.size = parse_size(o.size);
  std::optional<Scene> scene;
  if (o.scenes.size() > 1 && !o.failures.empty())
    refuse("--save-failures", "keeps the name of one scene file: not of several");
  if (!o.scenes.empty()) scene = import_files(o.scenes, o.import_options);
  const std::string name = scene_names(o.scenes);
  outputs.check_inputs();
  if (!o.heatmap.empty()) {
    const FilmSettings film = scene ? scene->view.film : verify::torture_scene(o.seed, 0).view.film;
    const ImageSize size = overrides.size.value_or(ImageSize{film.width, film.height});
    check_exr_size(size.width, size.height, report::heatmap_channels, "--size");
  }
  const std::vector<Device> devices = devices_of(o);
  install_interrupt_handlers();

  ProgressReporter progress(ProgressReporter::style_for_stderr(o.quiet));
  const Clock::time_point start = Clock::now();
  verify::Options options;
  options.rays = o.rays;
  options.seed = o.seed;
  options.progress = [&](std::uint64_t done) {
    if (done > 0) SecondTry::driver_works();
    progress.update(static_cast<double>(done) / static_cast<double>(o.rays), 0,
                    fmt::format("{}/{} rays, {:.3g} Mrays/s", done, o.rays,
                                static_cast<double>(done) / 1e6 / seconds_since(start)));
  };
  const verify::Report found = verify::verify(scene ? &*scene : nullptr, name, devices, options);
  const std::string label = scene_label({name, o.seed, 0});
  fmt::print("{}",
             o.json ? report::json_text(found, label, options) : report::plain_text(found, label));

  std::size_t failures = 0;
  if (!o.failures.empty()) {
    std::vector<verify::Failure> all;
    for (const verify::DeviceReport& device : found.devices)
      all.insert(all.end(), device.failures.begin(), device.failures.end());
    failures = all.size();
    if (failures > 0) {
      verify::save_cases(o.failures, all);
      log::info("{} cases in {}: see caplet verify --replay {}", failures, o.failures, o.failures);
    }
  }
  if (!o.heatmap.empty() && !found.interrupted) {
    Scene shown = scene ? *scene : verify::torture_scene(o.seed, 0);
    apply(overrides, shown);
    report::write_heatmap(o.heatmap, shown, verify::heatmap(shown, devices));
    log::info("wrote {}", o.heatmap);
  }
  if (found.disagreements() > 0) throw CLI::RuntimeError(exit_disagreed);
  if (found.interrupted) throw RunError("interrupted before all rays were asked");
}

}  // namespace

void add_verify(CLI::App& app) {
  const auto o = std::make_shared<VerifyFlags>();
  CLI::App* command =
      app.add_subcommand("verify",
                         "Compare a device's hits with the host reference, ray by ray: exit code 3 "
                         "when they disagree beyond the stated bounds");
  command
      ->add_option("SCENE", o->scenes,
                   "Scene file, or several that make one scene (" + scene_extensions() +
                       "); none: a built-in torture set of all shapes")
      ->type_name("SCENE");
  command->option_defaults()->group("Rays");
  command->add_option("--rays", o->rays, "How many rays")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--seed", o->seed, "Other rays, and another torture set")
      ->capture_default_str()
      ->type_name("S");
  command->option_defaults()->group("Devices");
  add_device(*command, o->device);
  add_encoding(*command, o->encoding);
  command->add_flag("--all-devices", o->all_devices,
                    "Every device there is, and one against the other");
  command->option_defaults()->group("Output");
  command->add_flag("--json", o->json, "Print a JSON object for machines");
  command
      ->add_option("--heatmap", o->heatmap,
                   "Also write a picture of how far off each pixel is, in units of the bounds")
      ->type_name("OUT.exr");
  command->add_option("--size", o->size, "Size of that picture, as in `render`")->type_name("WxH");
  command
      ->add_option("--save-failures", o->failures,
                   "Folder for rays that disagree, one file each (at most 100 a device)")
      ->type_name("DIR");
  command->option_defaults()->group("Rays");
  command->add_option("--replay", o->replay, "Ask saved rays again: one file, or a folder of them")
      ->type_name("FILE|DIR");
  command->option_defaults()->group("Output");
  command->add_flag("-q,--quiet", o->quiet, "Only warnings and errors");
  add_import_options(*command, o->import_options);
  command->footer(
      footer_with({"caplet verify --rays 100000", "caplet verify scene.pbrt --all-devices"}));
  command->callback([o] { run_verify(*o); });
}

}  // namespace caplet::cli
