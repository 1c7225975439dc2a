// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet pick`: queries what a pixel shows, or what one ray or each of millions of rays hits.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <memory>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/options.h"
#include "cli/trees.h"
#include "cli/trial.h"
#include "device/second_try.h"
#include "lower/camera.h"
#include "lower/lower.h"
#include "present/film_window.h"
#include "render/query.h"
#include "report/pick_report.h"
#include "report/pick_table.h"
#include "scene/frozen.h"
#include "table/ray_file.h"

namespace caplet::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t rays_in_a_chunk = std::size_t{1} << 18;
constexpr std::size_t crossings_in_a_chunk =
    std::size_t{1} << 22;  // the most per chunk, whatever --limit allows per ray

struct PickFlags {
  Encoding encoding = Encoding::automatic;
  std::vector<std::string> scenes;
  std::string pixel, ray, rays, out, device, size, crop;
  ImportOptions import_options;
  std::size_t limit = 256;
  std::optional<double> time;
  bool all = false, json = false, reference = false, quiet = false;
};

RayRecord to_record(const RayNumbers& n) {
  return {n[0], n[1], n[2], 0, n[3], n[4], n[5], std::numeric_limits<float>::infinity()};
}

[[noreturn]] void refuse_overflow(const std::vector<std::uint64_t>& rays, std::size_t limit) {
  constexpr std::size_t named = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(rays.size(), named); ++i)
    names += fmt::format("{}{}", i > 0 ? ", " : "", rays[i]);
  if (rays.size() > named) names += fmt::format(" and {} more", rays.size() - named);
  throw RunError(fmt::format("ray {}: more than {} crossings; nothing is written (raise --limit)",
                             names, limit));
}

// --- One ray ---

void pick_one(const PickFlags& options, const Scene& scene, const FlatScene& flat,
              const std::optional<std::array<int, 2>>& pixel, const RayRecord& ray,
              const Device& device) {
  Query query(flat, device);
  report::PickReport told;
  told.pixel = pixel;
  told.ray = ray;
  told.device = device.info().name;
  told.all = options.all;
  if (options.all) {
    HitLists lists = query.all(std::span(&ray, 1), options.limit);
    if (!lists.overflowed.empty()) refuse_overflow({0}, options.limit);
    told.crossings = std::move(lists.crossings);
  } else if (const PickRecord pick = query.closest(std::span(&ray, 1))[0];
             pick.object != CAPLET_NONE) {
    told.crossings = {pick};
  }
  SecondTry::driver_works();
  if (options.reference) told.reference = report::reference_crossings(scene, ray, options.all);
  fmt::print("{}", options.json ? report::json_text(told, scene) : report::plain_text(told, scene));
}

// --- Lists of rays ---

/// Returns the rows of a chunk of rays, numbered from `first`. Rays with more crossings than the
/// limit go to `overflowed`.
std::vector<report::PickRow> answer(Query& query, std::span<const RayRecord> rays,
                                    std::uint64_t first, const PickFlags& options,
                                    std::vector<std::uint64_t>& overflowed) {
  std::vector<report::PickRow> rows;
  if (options.all) {
    const HitLists lists = query.all(rays, options.limit);
    for (const std::size_t ray : lists.overflowed) overflowed.push_back(first + ray);
    rows.reserve(lists.crossings.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
      for (std::size_t k = lists.begin[i]; k < lists.begin[i + 1]; ++k)
        rows.push_back({first + i, lists.crossings[k]});
    return rows;
  }
  const std::vector<PickRecord> picks = query.closest(rays);
  rows.reserve(picks.size());
  for (std::size_t i = 0; i < picks.size(); ++i)
    if (picks[i].object != CAPLET_NONE) rows.push_back({first + i, picks[i]});
  return rows;
}

void pick_many(const PickFlags& options, const Scene& scene, const FlatScene& flat, RayFile& file,
               const fs::path& out, const Device& device) {
  const Clock::time_point start = Clock::now();
  const auto seconds = [start] { return seconds_since(start); };
  Query query(flat, device);
  // Kernels are compiled before the rays are read: after a driver's crash the program starts again,
  // and a pipe cannot be read twice.
  const RayRecord any{0, 0, 0, 0, 0, 0, 1, std::numeric_limits<float>::infinity()};
  std::vector<std::uint64_t> ignored;
  answer(query, std::span(&any, 1), 0, options, ignored);
  if ((options.rays == "-" || is_stream(options.rays))) SecondTry::driver_works();
  std::uint64_t ray_count = 0, row_count = 0;
  double device_seconds = 0;
  const std::size_t chunk =
      options.all
          ? std::clamp<std::size_t>(crossings_in_a_chunk / options.limit, 1, rays_in_a_chunk)
          : rays_in_a_chunk;
  write_atomically(out, [&](const fs::path& temporary) {
    const std::unique_ptr<report::PickTable> table =
        report::create_pick_table(temporary, report::table_format(out).value(), scene, out);
    std::vector<std::uint64_t> overflowed;
    for (;;) {
      if (interrupt_requested()) throw RunError("interrupted; nothing is written");
      const std::vector<ListedRay> listed = file.next(chunk);
      std::vector<RayRecord> rays;
      rays.reserve(listed.size());
      for (const ListedRay& one : listed) {
        rays.push_back(to_record(one.numbers));
        rays.back().t_min = one.t_min;
        rays.back().t_max = one.t_max;
      }
      const double before = seconds();
      const std::vector<report::PickRow> rows = answer(query, rays, ray_count, options, overflowed);
      device_seconds += seconds() - before;
      SecondTry::driver_works();
      if (overflowed.empty())
        table->append(rows);  // otherwise reads on only to list all rays that overflow
      ray_count += rays.size();
      row_count += rows.size();
      if (rays.size() < chunk) break;
    }
    if (!overflowed.empty()) refuse_overflow(overflowed, options.limit);
    table->finish();
  });
  device_seconds -= query.compile_seconds();
  log::info("{} rays, {} crossings on {}: {:.3g} Mrays/s, {:.1f} s in all; wrote {}", ray_count,
            row_count, device.info().name,
            static_cast<double>(ray_count) / 1e6 / std::max(device_seconds, 1e-9), seconds(),
            out.string());
}

// --- The command ---

void check_combination(const PickFlags& o) {
  const int asked = !o.pixel.empty() + !o.ray.empty() + !o.rays.empty();
  if (asked != 1)
    throw InputError("pick needs one of --pixel X,Y, --ray ox,oy,oz,dx,dy,dz and --rays FILE");
  const auto refuse = [](const char* flag, const char* why) {
    throw InputError(SourceLocation{flag}, why);
  };
  if (!o.rays.empty()) {
    if (o.out.empty()) refuse("--rays", "needs --out FILE.csv or FILE.npy");
    if (o.json) refuse("--json", "tells of one ray: it does not go with --rays");
    if (o.reference) refuse("--reference", "tells of one ray: it does not go with --rays");
  } else if (!o.out.empty()) {
    refuse("--out", "goes with --rays");
  }
  if (o.pixel.empty() && !(o.size.empty() && o.crop.empty()))
    refuse(o.size.empty() ? "--crop" : "--size", "goes with --pixel");
}

/// Reads the tree file that is picked in. Throws InputError for what needs its scene.
Tree tree_to_pick(const PickFlags& options) {
  if (options.reference)
    throw InputError(SourceLocation{"--reference"}, "needs a scene: a tree file has no shapes");
  Tree out = read_tree(options.scenes.front(), options.import_options);
  if (out.file.scene.moves())
    throw InputError({options.scenes.front()},
                     "the tree file is of a scene that moves: pick in the scene itself, which is "
                     "stopped at --time");
  return out;
}

void run_pick(const PickFlags& options, bool has_limit) {
  log::set_quiet(options.quiet);
  check_combination(options);
  if (has_limit && !options.all) throw InputError(SourceLocation{"--limit"}, "goes with --all");
  Overrides overrides;
  if (!options.size.empty()) overrides.size = parse_size(options.size);
  if (!options.crop.empty()) overrides.crop = parse_crop(options.crop);
  std::optional<std::array<int, 2>> pixel;
  if (!options.pixel.empty()) pixel = parse_pixel(options.pixel);
  std::optional<RayRecord> ray;
  if (!options.ray.empty()) ray = to_record(parse_ray(options.ray));
  const fs::path out = output_named(options.out);
  Outputs outputs;
  std::optional<RayFile> rays;
  if (!options.rays.empty()) {
    report::check_table_format(out, "--out");
    outputs.add("--out", out);
    rays.emplace(options.rays);
    outputs.check_inputs();
    install_interrupt_handlers();
  }
  const Device device = choose_device(options.device, options.encoding);
  std::optional<Tree> tree;
  if (is_tree(options.scenes)) tree = tree_to_pick(options);
  Scene scene =
      tree ? std::move(tree->scene) : import_files(options.scenes, options.import_options);
  outputs.check_inputs();
  apply(overrides, scene);
  if (moves(scene))
    scene = frozen_at(std::move(scene), options.time.value_or(scene.view.film.shutter_open));
  if (pixel) {
    with_flag("--pixel", [&] { check_pixel(*pixel, scene.view.film); });
    ray = ray_of_pixel(scene, (*pixel)[0], (*pixel)[1]);
  }
  const FlatScene flat = tree ? std::move(tree->file.scene) : lower(scene);
  try_device_apart(device, {.shapes = flat.shapes, .nearest = !options.all, .lists = options.all});
  SecondTry::guard(device);
  if (rays)
    pick_many(options, scene, flat, *rays, out, device);
  else
    pick_one(options, scene, flat, pixel, *ray, device);
}

}  // namespace

void add_pick(CLI::App& app) {
  const auto o = std::make_shared<PickFlags>();
  CLI::App* command = app.add_subcommand(
      "pick", "Tell what a pixel shows or rays hit: name, surface, material, point, normal, uv");
  add_scene_files(*command, o->scenes);
  command->option_defaults()->group("What is asked");
  command
      ->add_option("--pixel", o->pixel,
                   "The ray through the middle of this pixel, from the top left")
      ->type_name("X,Y");
  command
      ->add_option("--ray", o->ray,
                   "This ray: origin and direction (of any length; t counts in its lengths)")
      ->type_name("ox,oy,oz,dx,dy,dz");
  command
      ->add_option("--rays", o->rays,
                   "Many rays: text of six numbers a line, or .npy (N x 6); with t_min and t_max "
                   "eight; -: text from stdin")
      ->type_name("FILE");
  command->option_defaults()->group("Output");
  command
      ->add_option("--out", o->out,
                   "Table of what --rays hit, a row per crossing: .csv or .npy; -: CSV to stdout")
      ->type_name("FILE");
  command->option_defaults()->group("What is asked");
  command->add_flag("--all", o->all, "Every crossing in order, not the nearest alone");
  CLI::Option* limit =
      command
          ->add_option("--limit", o->limit, "Most crossings of a ray for --all; more are an error")
          ->check(CLI::Range(std::size_t{1}, max_query_capacity))
          ->capture_default_str()
          ->type_name("N");
  command->option_defaults()->group("Output");
  command->add_flag("--json", o->json, "Print a JSON object for machines; not with --rays");
  command->option_defaults()->group("What is asked");
  command->add_flag("--reference", o->reference,
                    "Also print what the host reference finds by another method; not with --rays");
  command->option_defaults()->group("Device");
  add_device(*command, o->device);
  add_encoding(*command, o->encoding);
  command->option_defaults()->group("What is asked");
  command->add_option("--size", o->size, "Picture size that --pixel counts in, as in `render`")
      ->type_name("WxH");
  command->add_option("--crop", o->crop, "Pixels that may be picked, as in `render`")
      ->type_name("x0,y0,x1,y1");
  command
      ->add_option("--time", o->time,
                   "When rays see a scene that moves; else when its shutter opens")
      ->type_name("SECONDS");
  command->option_defaults()->group("Output");
  command->add_flag("-q,--quiet", o->quiet, "Only warnings and errors");
  add_import_options(*command, o->import_options);
  command->footer(footer_with(
      {"caplet pick scene.pbrt --pixel 640,360",
       "caplet pick scene.pbrt --rays rays.npy --out hits.npy"},
      "One of --pixel, --ray and --rays is needed. A ray that hits nothing is no error."));
  command->callback([o, limit] { run_pick(*o, limit->count() > 0); });
}

}  // namespace caplet::cli
