// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet film`: tells what is in a film.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/description.h"
#include "film/film_file.h"
#include "report/summary.h"

namespace caplet::cli {

namespace {

nlohmann::ordered_json spans(const std::vector<SampleSpan>& samples) {
  auto out = nlohmann::ordered_json::array();
  for (const SampleSpan& span : samples) out.push_back({span.begin, span.end});
  return out;
}

nlohmann::ordered_json summary(const SavedFilm& saved) {
  const FilmLayout& layout = saved.film.layout();
  const Window& window = layout.window;
  nlohmann::ordered_json out;
  out["size"] = {layout.width, layout.height};
  out["crop"] = {window.x, window.y, window.x + window.width, window.y + window.height};
  out["layers"] = options_of(layout.layers);
  const std::vector<SampleSpan> samples = samples_of(saved.film);
  out["samples"] = spans(samples);
  out["samples_wanted"] = saved.samples_wanted;
  out["mean_samples"] = saved.film.mean_samples();
  out["missing"] = spans(missing(samples, saved.samples_wanted));
  out["scene_hash"] = saved.scene;
  out["view_hash"] = saved.view;
  constexpr std::string_view own = "caplet.";
  for (const auto& [name, value] : saved.notes)
    if (name.starts_with(own)) out[name.substr(own.size())] = value;
  return out;
}

void print_text(const SavedFilm& saved) {
  const FilmLayout& layout = saved.film.layout();
  const Window& window = layout.window;
  const std::vector<SampleSpan> samples = samples_of(saved.film),
                                left = missing(samples, saved.samples_wanted);
  fmt::print("picture      {} x {} pixels", layout.width, layout.height);
  if (window.width != layout.width || window.height != layout.height)
    fmt::print(", of which {},{} to {},{}", window.x, window.y, window.x + window.width,
               window.y + window.height);
  fmt::print("\nsamples      {}", text_of(samples));
  if (saved.samples_wanted > 0) fmt::print(" of {}", saved.samples_wanted);
  if (!saved.film.is_even())
    fmt::print(", of a pixel {:.1f} in the mean", saved.film.mean_samples());
  fmt::print("\n");
  if (!left.empty()) fmt::print("missing      {}\n", text_of(left));
  for (const auto& [label, name] : {std::pair{"scene", "caplet.scene"},
                                    {"seed", "caplet.seed"},
                                    {"device", "caplet.device"},
                                    {"driver", "caplet.driver"},
                                    {"platform", "caplet.platform"},
                                    {"program", "software"},
                                    {"command", "caplet.command"},
                                    {"seconds", "caplet.render_seconds"}})
    if (const auto found = saved.notes.find(name); found != saved.notes.end())
      fmt::print("{:<12} {}\n", label, found->second);
  fmt::print("scene hash   {}\nview hash    {}\n", saved.scene, saved.view);
}

}  // namespace

void add_film(CLI::App& app) {
  struct Options {
    std::string film;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "film", "Tell what is in a film: picture, samples, missing ones, scene, devices");
  command->add_option("FILM", options->film, "A film that render or merge wrote")
      ->required()
      ->type_name("FILE.film");
  command->add_flag("--json", options->json, "Print JSON for machines");
  command->footer(footer_with({"caplet film picture.film"}));
  command->callback([options] {
    const SavedFilm saved = load_film(options->film);
    options->json ? fmt::print("{}", report::to_text(summary(saved))) : print_text(saved);
  });
}

}  // namespace caplet::cli
