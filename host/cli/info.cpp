// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet info`: describes a scene without rendering it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/description.h"
#include "cli/options.h"
#include "cli/parameters.h"
#include "cli/trees.h"
#include "lower/lower.h"
#include "report/summary.h"

namespace caplet::cli {

namespace {

void print_text(const nlohmann::ordered_json& info) {
  fmt::print("scene        {}\n", info["scene"].get<std::string>());
  for (const char* counts : {"contents", "primitives"})
    for (const auto& [kind, count] : info[counts].items())
      fmt::print("{:<12} {}\n", kind, count.get<std::uint64_t>());
  if (const auto& bounds = info["bounds"]; bounds.is_null()) {
    fmt::print("bounds       none: there are no shapes\n");
  } else {
    const auto &low = bounds["min"], &high = bounds["max"];
    fmt::print("bounds       ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n",
               low[0].get<double>(), low[1].get<double>(), low[2].get<double>(),
               high[0].get<double>(), high[1].get<double>(), high[2].get<double>());
  }
  fmt::print("materials    {}\nlights       {}\n", info["materials"].get<std::uint64_t>(),
             info["lights"].get<std::uint64_t>());
  if (const auto moving = info["moving"].get<std::uint64_t>(); moving > 0)
    fmt::print("moving       {} of {} instances\n", moving, info["instances"].get<std::uint64_t>());
  for (const std::string kind : {"capsules", "triangles"})
    if (const auto moving = info["moving_" + kind].get<std::uint64_t>(); moving > 0)
      fmt::print("moving       {} {}\n", moving, kind);
  const int samples = info["samples_per_pixel"].get<int>();
  fmt::print("image        {} x {}, {}\n", info["image"]["width"].get<int>(),
             info["image"]["height"].get<int>(),
             info.contains("noise") ? fmt::format("noise {:g} %, at most {} samples per pixel",
                                                  100 * info["noise"].get<double>(), samples)
                                    : fmt::format("{} samples per pixel", samples));
  fmt::print("bytes        {} host, {} device\n", info["bytes"]["host"].get<std::uint64_t>(),
             info["bytes"]["device"].get<std::uint64_t>());
  fmt::print("bvh          {} nodes, depth {}, SAH cost {:.4g}\n",
             info["bvh"]["nodes"].get<std::uint64_t>(), info["bvh"]["depth"].get<int>(),
             info["bvh"]["sah"].get<double>());
}

}  // namespace

void add_info(CLI::App& app) {
  struct Options {
    std::vector<std::string> scenes;
    ImportOptions import_options;
    bool json = false, parameters = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "info", "Tell what a scene file holds: primitives, bounds, materials, lights, memory, tree");
  add_scene_files(*command, options->scenes);
  command->get_option("SCENE")->required(false);
  command->add_flag("--json", options->json, "Print JSON for machines");
  command->add_flag("--parameters", options->parameters,
                    "List what scene files may say, in place of a scene: families and their types; "
                    "of a family, or of a family "
                    "and a type, the parameters with types, defaults, ranges and units");
  add_import_options(*command, options->import_options);
  command->footer(footer_with({"caplet info scene.pbrt", "caplet info neuron.swc --json",
                               "caplet info --parameters material conductor"}));
  command->callback([options] {
    if (options->parameters) {
      fmt::print("{}", options->json ? parameters_json(options->scenes)
                                     : parameters_text(options->scenes));
      return;
    }
    if (options->scenes.empty()) throw CLI::RequiredError("SCENE");
    nlohmann::ordered_json info;
    if (is_tree(options->scenes)) {
      Tree tree = read_tree(options->scenes.front(), options->import_options);
      check_tree(options->scenes.front(), tree.file);
      info = std::move(tree.summary);
    } else {
      const Scene scene = import_files(options->scenes, options->import_options);
      info = report::scene_summary(scene, lower(scene));
    }
    options->json ? fmt::print("{}", report::to_text(info)) : print_text(info);
  });
}

}  // namespace caplet::cli
