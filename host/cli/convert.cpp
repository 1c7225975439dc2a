// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet convert`: converts any scene file to pbrt text.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/options.h"
#include "export/export.h"
#include "lower/lower.h"
#include "report/summary.h"

namespace caplet::cli {

namespace {

struct ConvertFlags {
  std::vector<std::string> scenes;
  std::string output;
  ImportOptions import_options;
  bool quiet = false, json = false;
};

void run_convert(const ConvertFlags& options) {
  log::set_quiet(options.quiet);
  const std::filesystem::path output = output_named(options.output);
  Outputs outputs;
  outputs.add("OUT.pbrt", output);
  if (options.json && is_stream(output))
    throw InputError(SourceLocation{"--json"}, "does not go with a scene on stdout");
  if (output.extension() != ".pbrt" && !is_stream(output))
    throw InputError(SourceLocation{"OUT.pbrt"},
                     "'" + output.string() + "': scenes are written as pbrt text, to a file .pbrt");
  install_interrupt_handlers();
  const Scene scene = import_files(options.scenes, options.import_options);
  outputs.check_inputs();
  const FileImageWriter images;
  write_scene(scene, output, interrupt_requested, &images);
  if (!is_stream(output)) log::info("wrote {}", output.string());
  if (!options.json) return;
  nlohmann::ordered_json told{{"wrote", output.string()}};
  told.update(report::scene_summary(scene, lower(scene)));
  fmt::print("{}", report::to_text(told));
}

}  // namespace

void add_convert(CLI::App& app) {
  const auto o = std::make_shared<ConvertFlags>();
  CLI::App* command = app.add_subcommand(
      "convert", "Write any scene file as pbrt text that gives the same picture");
  command
      ->add_option(
          "FILES", o->scenes,
          "SCENE... OUT.pbrt: a scene file, or several that make one scene, of any formats (" +
              scene_extensions() + "), then the scene file to write; -: to stdout")
      ->required()
      ->type_name("SCENE");
  command->add_flag("--json", o->json, "Print what was written as JSON, as `caplet info --json`");
  command->add_flag("-q,--quiet", o->quiet, "Only warnings and errors");
  add_import_options(*command, o->import_options);
  command->footer(footer_with({"caplet convert molecule.pdb --style sticks molecule.pbrt"},
                              "The picture of the written scene is that of the first one, bit for "
                              "bit. Images and other files that the scene names "
                              "are not copied: the text names them relative to OUT.pbrt. Comments, "
                              "includes and the names of transforms are not kept."));
  command->callback([o] {
    if (o->scenes.size() < 2) throw CLI::RequiredError("OUT.pbrt");
    o->output = o->scenes.back();
    o->scenes.pop_back();
    run_convert(*o);
  });
}

}  // namespace caplet::cli
