// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/film_output.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "cli/options.h"

namespace caplet::cli {

namespace fs = std::filesystem;

void add_film_flags(CLI::App& command, FilmFlags& flags) {
  command.option_defaults()->group("Film");
  command
      .add_option(
          "--film", flags.film,
          "Write the film, the exact sums of the samples, which merge adds and --resume goes "
          "on with; without -o nothing else")
      ->type_name("FILE.film")
      ->default_str("none; of --checkpoint and --resume the first output's name, .film");
  command
      .add_option_function<std::string>(
          "--checkpoint",
          [&flags](const std::string& text) {
            flags.checkpoint = parse_seconds("--checkpoint", text);
            if (*flags.checkpoint < 0.1)
              throw InputError(SourceLocation{"--checkpoint"},
                               fmt::format("'{}' is less than 0.1 seconds", text));
          },
          "Write the film while rendering, so often: seconds, or 5m, or 1h30m")
      ->type_name("TIME");
  command.add_flag("--resume", flags.resume, "Go on after the samples of the film, if it is there");
  command
      .add_option(
          "--samples", flags.samples,
          "Render only samples A to B - 1 of every pixel, or share I (from 1) of N equal ones")
      ->type_name("A:B|I/N");
}

SampleSpan parse_samples(const std::string& text, std::uint32_t wanted) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(SourceLocation{"--samples"}, fmt::format("'{}' {}", text, why));
  };
  const std::size_t middle = text.find_first_of(":/");
  const auto number = [&](std::size_t begin, std::size_t end) {
    std::uint32_t value = 0;
    const auto [last, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    if (error != std::errc() || last != text.data() + end)
      refuse("is not A:B or I/N, of whole numbers");
    return value;
  };
  if (middle == std::string::npos) refuse("is not A:B or I/N, of whole numbers");
  const std::uint32_t a = number(0, middle), b = number(middle + 1, text.size());
  constexpr std::uint32_t most = 1u << 24;
  if (text[middle] == ':') {
    if (a >= b || b > most) refuse(fmt::format("is not A:B with A < B, up to {}", most));
    return {a, b};
  }
  if (a < 1 || a > b) refuse("is not I/N with I from 1 to N");
  const auto first = [&](std::uint32_t share) {
    return static_cast<std::uint32_t>(std::uint64_t{wanted} * share / b);
  };
  const SampleSpan span{first(a - 1), first(a)};
  if (span.begin == span.end) refuse(fmt::format("has no sample: there are {} of a pixel", wanted));
  return span;
}

FilmOutput::FilmOutput(fs::path path, SavedFilm like, bool resumes)
    : path_(std::move(path)), like_(std::move(like)) {
  std::error_code ignored;
  if (!resumes || !fs::exists(path_, ignored)) return;
  before_ = load_film(path_);
  forget_input(path_);
}

FilmOutput::~FilmOutput() {
  if (writing_.valid()) writing_.wait();
}

void FilmOutput::resume(Session& session, std::uint32_t begin,
                        const std::map<std::string, std::string>& now) {
  if (!before_) return;
  const auto refuse = [&](const std::string& why) {
    throw InputError(SourceLocation{path_.string()},
                     why + "; without --resume it would be replaced");
  };
  if (const std::string why =
          difference(before_->origin(), {session.layout(), like_.scene, like_.view});
      !why.empty())
    refuse("this film cannot be continued: " + why);
  const std::vector<SampleSpan> samples = samples_of(before_->film);
  if (samples.empty()) return;
  if (samples.size() > 1 || samples.front().begin != begin)
    refuse(fmt::format("this film has the samples {}, and those asked for begin at {}",
                       text_of(samples), begin));
  notes_before_ = std::move(before_->notes);
  if (made_on(notes_before_) != made_on(now))
    log::warn("{} was made on {}, and goes on on {}: it need not have the bits of one render",
              path_.string(), made_on(notes_before_), made_on(now));
  session.resume(std::move(before_->film));
  before_.reset();
  log::info("{}: goes on after sample {}", path_.string(), samples.front().end - 1);
}

std::map<std::string, std::string> FilmOutput::notes(std::map<std::string, std::string> now) const {
  return notes_before_.empty() ? now : notes_together(notes_before_, std::move(now));
}

void FilmOutput::checkpoint(Film film, std::map<std::string, std::string> notes, double seconds) {
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    writing_.get();
  }
  SavedFilm saved = like_;
  saved.film = std::move(film);
  saved.notes = std::move(notes);
  writing_ = std::async(std::launch::async, [path = path_, saved = std::move(saved), seconds] {
    try {
      save_film(path, saved, seconds);
    } catch (const std::exception& error) {
      log::warn("{}; the film keeps its last checkpoint, and the render goes on", error.what());
    }
  });
}

void FilmOutput::finish(Film& film, std::map<std::string, std::string> notes, double seconds) {
  if (writing_.valid()) writing_.get();
  if (film.parts().empty()) return;
  like_.notes = std::move(notes);
  std::swap(like_.film, film);  // not copied, and given back whatever happens
  try {
    save_film(path_, like_, seconds);
  } catch (...) {
    std::swap(like_.film, film);
    throw;
  }
  std::swap(like_.film, film);
}

}  // namespace caplet::cli
