// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet merge`: adds films and develops their sum.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "base/atomic_file.h"
#include "base/log.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/matte_options.h"
#include "cli/options.h"
#include "film/deep.h"
#include "film/denoise.h"
#include "film/film_file.h"
#include "film/image.h"
#include "present/picture_options.h"
#include "report/bands.h"
#include "report/denoised.h"
#include "report/mattes.h"
#include "report/picture.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

struct MergeFlags {
  std::vector<std::string> films, outputs;
  std::string preview, film, background, exposure;
  std::optional<std::string> layers;
  bool variance = false, denoise = false, quiet = false;
  MatteFlags mattes;
};

struct Targets {
  std::vector<fs::path> pictures, previews;
  fs::path film, deep;
  Outputs all;
};

Targets targets_of(const MergeFlags& flags) {
  Targets out;
  for (const std::string& name : flags.outputs) {
    const fs::path path = output_named(name);
    const bool is_exr = is_stream(path) || path.extension() == ".exr";
    if (!is_exr) check_preview_format(path, "-o");
    (is_exr ? out.pictures : out.previews).push_back(path);
    out.all.add("-o", path);
  }
  if (!flags.preview.empty()) {
    out.previews.emplace_back(flags.preview);
    check_preview_format(flags.preview, "--preview");
    out.all.add("--preview", flags.preview);
  }
  if (!flags.film.empty()) {
    out.film = output_named(flags.film);
    out.all.add("--film", out.film);
  }
  if (!flags.mattes.deep.empty()) {
    out.deep = deep_path(flags.mattes);
    out.all.add("--deep", out.deep);
  }
  if (out.pictures.empty() && out.previews.empty() && out.film.empty() && out.deep.empty())
    throw InputError(SourceLocation{"-o"},
                     "is missing: a picture (.exr, .png and the like), --deep or --film");
  return out;
}

SavedFilm sum_of(const std::vector<std::string>& files) {
  SavedFilm sum = load_film(files.front());
  const std::string maker = made_on(sum.notes);
  bool is_warned = false;
  for (std::size_t i = 1; i < files.size(); ++i) {
    const SavedFilm more = load_film(files[i]);
    if (!is_warned && made_on(more.notes) != maker) {
      log::warn("{} was made on {}, {} on {}: the sum need not have the bits of one render",
                files.front(), maker, files[i], made_on(more.notes));
      is_warned = true;
    }
    try {
      add(sum, more);
    } catch (const InputError& error) {
      throw InputError(SourceLocation{files[i]},
                       fmt::format("does not go with {}: {}", i == 1 ? files.front() : "the others",
                                   error.what()));
    }
  }
  return sum;
}

void warn_of_missing(const SavedFilm& sum) {
  const std::vector<SampleSpan> left = missing(samples_of(sum.film), sum.samples_wanted);
  if (!left.empty()) log::warn("samples {} are missing", text_of(left));
}

Layers layers_of(const MergeFlags& flags, const Film& film) {
  const Layers there = film.layout().layers;
  if (flags.mattes.cryptomatte && !there.has_all(Layers::mattes()))
    throw InputError(SourceLocation{"--cryptomatte"}, "the films do not have all mattes");
  if (!flags.mattes.deep.empty() && !there.has_all(deep_layers()))
    throw InputError(
        SourceLocation{"--deep"},
        "the films do not have what it takes (render --deep, or the layers Z and deep)");
  if (!flags.layers && !flags.variance) return there;
  const Layers asked = with_mattes(parse_layers(flags.layers, flags.variance), flags.mattes);
  if (flags.layers && !there.has_all(asked))
    throw InputError(SourceLocation{"--layers"}, "the films do not have all of these layers");
  if (!there.has_all(Layers::none().with(Layer::variance)) && flags.variance)
    throw InputError(SourceLocation{"--variance"}, "the films do not have the variance");
  return Layers::of_bits(asked.bits() & there.bits());
}

void run_merge(const MergeFlags& flags, const Invocation& invocation) {
  log::set_quiet(flags.quiet);
  Targets targets = targets_of(flags);
  SavedFilm sum = sum_of(flags.films);
  targets.all.check_inputs();
  if (sum.film.parts().empty())
    throw InputError(SourceLocation{flags.films.front()}, "there are no samples");
  if (!flags.background.empty())
    sum.settings.backdrop = parse_backdrop(flags.background, FileImageReader(), "--background");
  if (!flags.exposure.empty()) sum.settings.exposure = parse_exposure(flags.exposure, "--exposure");
  if (flags.denoise) sum.settings.denoise = true;
  if (sum.settings.denoise) check_denoiser("--denoise");
  if (flags.mattes.levels) sum.settings.matte_levels = *flags.mattes.levels;
  const Layers layers = layers_of(flags, sum.film);
  if (sum.settings.backdrop && sum.settings.backdrop->kind == Backdrop::Kind::transparent)
    for (const fs::path& preview : targets.previews) check_preview_alpha(preview, "--preview");
  warn_of_missing(sum);
  sum.notes["caplet.command"] = invocation.command_line();
  if (!targets.film.empty()) save_film(targets.film, sum);
  if (!targets.deep.empty())
    write_deep_exr(
        targets.deep, sum.film.layout(),
        [&](int first, int count) { return sum.film.rows(first, count); }, sum.notes);
  PictureFlaws flaws;
  BandedImage picture = report::developed(sum.film, sum.settings, layers, flaws);
  picture.whole.metadata = sum.notes;
  report::drop_other_mattes(picture.whole.metadata, layers);
  if (sum.settings.denoise) picture.whole.metadata["caplet.denoiser"] = denoiser_name();
  if (!targets.previews.empty()) report::fix_exposure({&picture, 1}, flaws);
  for (std::size_t i = 0; i < std::max(targets.pictures.size(), targets.previews.size()); ++i)
    report::write_pictures(i < targets.pictures.size() ? targets.pictures[i] : fs::path(),
                           i < targets.previews.size() ? targets.previews[i] : fs::path(), picture,
                           layers.channels(sum.settings.matte_levels) +
                               (sum.settings.denoise ? report::denoising_channels : 0),
                           0);
  flaws.warn();
  log::info("wrote {}: {} samples a pixel of {} films",
            !targets.pictures.empty()   ? targets.pictures.front().string()
            : !targets.previews.empty() ? targets.previews.front().string()
            : !targets.deep.empty()     ? targets.deep.string()
                                        : targets.film.string(),
            std::lround(sum.film.mean_samples()), flags.films.size());
}

}  // namespace

void add_merge(CLI::App& app, const Invocation& invocation) {
  const auto o = std::make_shared<MergeFlags>();
  CLI::App* command = app.add_subcommand(
      "merge", "Add films of one picture (render --film), in any order, to the bits of one render");
  command->add_option("FILM", o->films, "Films of different samples")
      ->required()
      ->type_name("FILE.film");
  command->option_defaults()->group("Output");
  command
      ->add_option("-o,--output", o->outputs,
                   "The picture, as often as there is to: .exr, or tone-mapped .png, .jpg and the "
                   "like")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("OUT.exr|OUT.png");
  command->add_option("--film", o->film, "Write the sum as a film")->type_name("FILE.film");
  command->add_option("--preview", o->preview, "Also write a tone-mapped 8-bit picture")
      ->type_name("FILE");
  command
      ->add_option("--layers", o->layers,
                   "Layers beside R G B A: some of " + layer_names() + ", or all, or none")
      ->type_name("all|none|LAYER,...")
      ->default_str("those of the films");
  command->add_flag("--variance", o->variance, "Write the variance among the layers");
  add_matte_flags(*command, o->mattes);
  command
      ->add_option("--background", o->background,
                   "What lies behind, as of render, in place of the films' own")
      ->type_name("transparent|COLOR|FILE");
  command
      ->add_option("--exposure", o->exposure,
                   "Previews are so much brighter, as of render, in place of the films' own")
      ->type_name("STOPS|auto");
  command->add_flag("--denoise", o->denoise, "Remove the noise of the picture, as render does");
  command->add_flag("-q,--quiet", o->quiet, "Only warnings and errors");
  command->footer(footer_with({"caplet merge a.film b.film -o picture.exr",
                               "caplet merge share-*.film -o picture.exr --film all.film"}));
  command->callback([o, &invocation] { run_merge(*o, invocation); });
}

}  // namespace caplet::cli
