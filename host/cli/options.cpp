// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/duration.h"
#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/spelling.h"
#include "film/image.h"
#include "import/import.h"
#include "import/picture_options.h"
#include "present/film_window.h"
#include "render/host_threads.h"

namespace caplet::cli {

namespace {

constexpr const char* usual_device = "a GPU where there is one";

/// Parses `text` as integers separated by `separator`; empty if it is anything else.
std::vector<long long> whole_numbers(std::string_view text, char separator) {
  std::vector<long long> out;
  for (;;) {
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return {};
    out.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return out;
    if (text.front() != separator) return {};
    text.remove_prefix(1);
  }
}

[[noreturn]] void refuse(const char* flag, const std::string& message) {
  throw InputError(SourceLocation{flag}, message);
}

}  // namespace

std::filesystem::path output_named(const std::string& text) {
  return text == "-" ? "/dev/stdout" : text;
}

ImageSize parse_size(const std::string& text) {
  const std::vector<long long> sides = whole_numbers(text, 'x');
  if (sides.size() != 2)
    refuse("--size", fmt::format("'{}' is not WIDTHxHEIGHT, like 960x540", text));
  if (sides[0] < 1 || sides[1] < 1)
    refuse("--size", fmt::format("'{}': both sides must be at least 1", text));
  if (sides[0] > most_image_pixels || sides[1] > most_image_pixels ||
      sides[0] * sides[1] > most_image_pixels)
    refuse("--size", fmt::format("'{}' is more than 2^28 pixels", text));
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

std::array<int, 4> parse_crop(const std::string& text) {
  const std::vector<long long> corners = whole_numbers(text, ',');
  if (corners.size() != 4) refuse("--crop", fmt::format("'{}' is not x0,y0,x1,y1 in pixels", text));
  for (const long long corner : corners)
    if (corner < 0 || corner > most_image_pixels)
      refuse("--crop", fmt::format("'{}': {} is out of range", text, corner));
  if (corners[0] >= corners[2] || corners[1] >= corners[3])
    refuse("--crop", fmt::format("'{}' is empty: x0 < x1 and y0 < y1 are needed", text));
  return {static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2]),
          static_cast<int>(corners[3])};
}

std::array<int, 2> parse_pixel(const std::string& text) {
  const std::vector<long long> numbers = whole_numbers(text, ',');
  if (numbers.size() != 2) refuse("--pixel", fmt::format("'{}' is not X,Y in whole pixels", text));
  for (const long long number : numbers)
    if (number < 0 || number > most_image_pixels)
      refuse("--pixel", fmt::format("'{}' is outside of any image", text));
  return {static_cast<int>(numbers[0]), static_cast<int>(numbers[1])};
}

RayNumbers parse_ray(const std::string& text) {
  std::array<double, 6> numbers{};
  std::size_t count = 0;
  for (std::string_view rest = text;; ++count) {
    if (count == numbers.size())
      refuse("--ray", fmt::format("'{}' is more than six numbers", text));
    const std::size_t comma = rest.find(',');
    if (const auto wrong = parse_number(rest.substr(0, comma), numbers[count]))
      refuse("--ray", *wrong);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (count != 5) refuse("--ray", fmt::format("'{}' is not ox,oy,oz,dx,dy,dz", text));
  RayNumbers ray{};
  if (const auto bad = to_ray(numbers, ray)) refuse("--ray", bad->message);
  return ray;
}

namespace {

/// Returns the layers that a name of --layers stands for.
Layers layers_named(std::string_view name) {
  if (name == "all") return Layers::all();
  const auto found = std::ranges::find_if(
      layer_rows, [&](const LayerRow& row) { return !name.empty() && row.option == name; });
  if (found != layer_rows.end())
    return Layers::none().with(static_cast<Layer>(found - layer_rows.begin()));
  std::vector<std::string> names;
  for (const LayerRow& row : layer_rows)
    if (*row.option) names.emplace_back(row.option);
  refuse("--layers", fmt::format("there is no layer '{}'; the nearest is '{}' (a list like "
                                 "Z,albedo, or all, or none)",
                                 name, nearest_name(name, names)));
}

}  // namespace

Layers parse_layers(const std::optional<std::string>& list, bool variance) {
  Layers layers = list ? Layers::none() : Layers::usual();
  if (list && *list != "none")
    for (std::string_view rest = *list;;) {
      const std::size_t comma = rest.find(',');
      layers = Layers::of_bits(layers.bits() | layers_named(rest.substr(0, comma)).bits());
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
  return variance ? layers.with(Layer::variance) : layers;
}

Device choose_device(const std::string& choice, Encoding encoding) {
  return with_device_flag([&] { return Device::choose(choice, encoding); });
}

std::vector<Device> choose_devices(const std::string& choice, Encoding encoding) {
  return with_device_flag([&] { return Device::choose_several(choice, encoding); });
}

namespace {

void add_threads(CLI::App& command) {
  command
      .add_option_function<unsigned>(
          "--threads", limit_host_threads,
          "Threads on processors: of PoCL's device, and of what is done beside it")
      ->type_name("N")
      ->check(CLI::Range(1U, 65536U))
      ->default_str("as many as processors");
}

}  // namespace

void add_device(CLI::App& command, std::string& choice) {
  add_threads(command);
  command
      .add_option(
          "--device", choice,
          "OpenCL device: index, cpu, gpu, bundled or part of its name (see `caplet devices`)")
      ->type_name("cpu|gpu|bundled|DEVICE")
      ->default_str(usual_device);
}

void add_devices_option(CLI::App& command, std::string& choice) {
  add_threads(command);
  command
      .add_option("--device", choice,
                  "OpenCL device: index, cpu, gpu, bundled or part of its name (see `caplet "
                  "devices`); some of these between "
                  "commas, or all")
      ->type_name("all|cpu|gpu|bundled|DEVICE,...")
      ->default_str(usual_device);
}

std::string layer_names() {
  std::vector<std::string> names;
  for (const LayerRow& row : layer_rows)
    if (*row.option) names.emplace_back(row.option);
  return fmt::format("{}", fmt::join(names, ", "));
}

void add_encoding(CLI::App& command, Encoding& encoding) {
  command
      .add_option_function<std::string>(
          "--encoding",
          [&encoding](const std::string& text) { encoding = parse_encoding(text, "--encoding"); },
          "How kernels go through the tree: wide (eight boxes at a time) or single; automatic: by "
          "the device")
      ->type_name("automatic|wide|single")
      ->default_str("automatic");
}

void apply(const Overrides& overrides, Scene& scene) {
  if (overrides.size) set_film_size(scene, overrides.size->width, overrides.size->height);
  if (overrides.crop) with_flag("--crop", [&] { set_crop(scene, *overrides.crop); });
  if (overrides.samples_per_pixel)
    scene.view.sampler.samples_per_pixel = *overrides.samples_per_pixel;
  if (overrides.seed) scene.view.sampler.seed = *overrides.seed;
  if (overrides.clamp) scene.view.film.max_component_value = *overrides.clamp;
  if (overrides.max_depth) scene.view.integrator.max_depth = *overrides.max_depth;
  if (overrides.denoise) scene.view.film.denoise = true;
  if (overrides.matte_levels) scene.view.film.matte_levels = *overrides.matte_levels;
}

void add_import_options(CLI::App& command, ImportOptions& options) {
  using Of = ImportOptionRow::Of;
  for (const ImportOptionRow& row : import_option_rows()) {
    if (row.of == Of::reading) {
      command
          .add_flag_callback(
              "--" + row.name, [&options, name = row.name] { options.set(name, "yes"); }, row.help)
          ->group("Reading");
      continue;
    }
    std::string formats_of_it;
    for (const Format& format : formats())
      if (std::ranges::find(format.options, row.name) != format.options.end())
        formats_of_it += (formats_of_it.empty() ? "" : ", ") + format.name;
    CLI::Option& option = *command.add_option_function<std::string>(
        "--" + row.name,
        [&options, name = row.name](const std::string& value) { options.set(name, value); },
        row.help + (row.of == Of::picture ? "" : " (" + formats_of_it + ")") +
            (row.name == "least-width" ? fmt::format("; at most {}; unless asked {}",
                                                     widest_least_width, usual_least_width())
                                       : ""));
    option.type_name(row.values)
        ->group(row.of == Of::picture ? "The picture" : "Files of other fields");
    if (row.is_list) option.multi_option_policy(CLI::MultiOptionPolicy::Join);
  }
  command
      .add_flag_callback(
          "--orthographic", [&options] { options.set("projection", "orthographic"); },
          "--projection orthographic")
      ->group("The picture");
}

CLI::Option* add_scene_files(CLI::App& command, std::vector<std::string>& scenes) {
  return command
      .add_option(
          "SCENE", scenes,
          "Scene file, or several that make one scene, of any formats: " + scene_extensions())
      ->required()
      ->type_name("SCENE");
}

Scene import_files(const std::vector<std::string>& scenes, const ImportOptions& options) {
  const StepNotice notice("reading " + scene_names(scenes),
                          ProgressReporter::style_for_stderr(!log::is_shown(LogLevel::info)));
  return import_scenes(std::vector<std::filesystem::path>(scenes.begin(), scenes.end()),
                       FileImageReader(), options);
}

std::string scene_names(const std::vector<std::string>& scenes) {
  return fmt::format("{}", fmt::join(scenes, " "));
}

std::string scene_extensions() {
  std::vector<std::string> all;
  for (const Format& format : formats())
    for (const std::string& extension : format.extensions)
      if (std::ranges::find(all, extension) == all.end()) all.push_back(extension);
  return fmt::format("{}", fmt::join(all, " "));
}

double parse_seconds(const std::string& option, const std::string& text) {
  if (const auto seconds = seconds_of(text)) return *seconds;
  throw InputError(SourceLocation{option},
                   fmt::format("'{}' is not a positive time, such as 90, 5m or 1h30m", text));
}

double parse_noise(const std::string& text) {
  const bool is_percent = text.ends_with('%');
  const char* const end = text.data() + text.size() - (is_percent ? 1 : 0);
  double value = 0;
  const auto [last, error] = std::from_chars(text.data(), end, value);
  const double noise = is_percent ? value / 100 : value;
  if (error != std::errc() || last != end || !(noise >= 1e-5 && noise <= 1))
    throw InputError(SourceLocation{"--noise"},
                     fmt::format("'{}' is not a share from 0.001% to 100%, such as 5%", text));
  return noise;
}

std::string usual_noise_text() { return fmt::format("{:g}%", 100 * usual_noise); }

std::string usual_least_width() {
  std::string out = fmt::format("{}", FilmSettings{}.least_width);
  for (const Format& format : formats())
    if (format.least_width != FilmSettings{}.least_width)
      out += fmt::format(", {} of {}", format.least_width, format.name);
  return out;
}

std::string usual_size() {
  const FilmSettings usual;
  return fmt::format("{}x{}", usual.width, usual.height);
}

}  // namespace caplet::cli
