// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet build`: lowers a scene to a tree file, from which renders begin at once.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/options.h"
#include "cli/trees.h"
#include "lower/lower.h"
#include "present/least_width.h"

namespace caplet::cli {

namespace {

struct BuildFlags {
  std::vector<std::string> scenes;
  std::string output, size;
  ImportOptions import_options;
  bool quiet = false;
};

void run_build(const BuildFlags& options) {
  log::set_quiet(options.quiet);
  const std::filesystem::path output = output_named(options.output);
  if (output.extension() != ".tree" || is_stream(output))
    throw InputError(SourceLocation{"OUT.tree"},
                     "'" + output.string() + "': a tree is written to a file .tree");
  Outputs outputs;
  outputs.add("OUT.tree", output);
  Overrides overrides;
  if (!options.size.empty()) overrides.size = parse_size(options.size);
  install_interrupt_handlers();
  const EndsAtOnce interrupted("caplet: error: interrupted; nothing is written\n", 1);
  const ProgressReporter::Style style = ProgressReporter::style_for_stderr(options.quiet);
  Stopwatch phase;
  Scene scene = import_files(options.scenes, options.import_options);
  outputs.check_inputs();
  apply(overrides, scene);
  TreeWriter writer(scene, std::filesystem::absolute(output).parent_path());
  widen_to_least(scene);
  const double read = phase.lap();
  std::optional<StepNotice> notice(std::in_place, "building the tree", style);
  const FlatScene flat = lower_and_release(scene);
  notice.reset();
  const double built = phase.lap();
  ProgressReporter reporter(style);
  writer.write(output, flat, [&](double fraction) { reporter.update(fraction, 0, "written"); });
  log::info(
      "wrote {}: {} primitives, {:.0f} MB; read in {:.1f} s, built in {:.1f} s, written in "
      "{:.1f} s",
      output.string(), flat.primitive_count, static_cast<double>(flat.device_bytes()) * 1e-6, read,
      built, phase.lap());
}

}  // namespace

void add_build(CLI::App& app) {
  const auto o = std::make_shared<BuildFlags>();
  CLI::App* command =
      app.add_subcommand("build", "Make a tree file of a large scene, which renders at once");
  command
      ->add_option("FILES", o->scenes,
                   "SCENE... OUT.tree: a scene file, or several that make one scene, of any "
                   "formats (" +
                       scene_extensions() + "), then the tree file to write")
      ->required()
      ->type_name("SCENE");
  command
      ->add_option("--size", o->size,
                   "Picture size: the automatic camera and least widths are for it")
      ->type_name("WxH");
  command->add_flag("-q,--quiet", o->quiet, "Only warnings and errors");
  add_import_options(*command, o->import_options);
  command->footer(footer_with(
      {"caplet build tracts.trk tracts.tree", "caplet build cell.swc cell.tree --size 960x540"},
      "render, pick and info take a tree file in place of the scene. It is mapped into memory: a "
      "CPU reads the pages that rays touch. It is of one version of Caplet, and trusted: make it "
      "yourself, as you would a program."));
  command->callback([o] {
    if (o->scenes.size() < 2) throw CLI::RequiredError("OUT.tree");
    o->output = o->scenes.back();
    o->scenes.pop_back();
    run_build(*o);
  });
}

}  // namespace caplet::cli
